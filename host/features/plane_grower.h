#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/features/connected_points.h"
#include "host/features/neighbourhoods.h"
#include "host/features/plane_fit.h"
#include "host/features/region.h"

namespace emax {

// Grows regions of planes over the graph of neighbours, and knows which points are in one. The
// points lie around the origin and outlive the grower, as do the neighbourhoods.
class PlaneGrower {
 public:
  PlaneGrower(std::span<const Point> points, const Neighbourhoods& near,
              const FeatureOptions& options);

  bool is_free(std::uint32_t point) const { return owner_[point] == kNoRegion; }
  // Whether a region may still begin there: the point is free and no region failed over it.
  bool may_begin(std::uint32_t point) const { return is_free(point) && !failed_[point]; }

  // The region around a point: it grows from the point's neighbourhood, its plane follows as it
  // grows, and in the end it is grown anew on the plane that fits it robustly. Where that is no
  // plane, or too few points, no region begins at those points again. O(n k) for n points of the
  // region.
  bool grow_from(std::uint32_t seed);
  // The same where the plane is known, from its first point on.
  bool grow_on(const Plane& plane, std::uint32_t first);

  // At the end: free points within the band that have at least half of their neighbours in one
  // region, as at edges, where no neighbourhood fits, join it. Two rounds. O(n k).
  std::vector<Region> finished() &&;

 private:
  bool fits(std::uint32_t point, const Plane& plane, const Eigen::Vector3f& normal) const;
  void gather(const Plane& plane, std::uint32_t first);
  void gather_with_refits(std::uint32_t seed);
  bool settle(Plane plane);
  void fail(std::span<const std::uint32_t> members);
  // Of the points that the region grew from, the one nearest to the plane.
  std::uint32_t nearest_of_first(const Plane& plane) const;
  double rms_from(const Plane& plane) const;  // of members_
  // Of members_; nothing where they are no plane.
  std::optional<Region> judged(const Plane& plane) const;
  void join_edges();

  std::span<const Point> points_;
  const Neighbourhoods& near_;
  FeatureOptions options_;
  std::vector<std::uint32_t> owner_;  // kNoRegion: free
  std::vector<bool> failed_;
  ConnectedPoints connected_;
  std::vector<std::uint32_t> members_;  // of the region that is growing, in the order of growth
  std::vector<Region> regions_;         // their points follow in the end
};

}  // namespace emax
