#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/decimate/slot_tree.h"
#include "host/decimate/triangle_sheet.h"

namespace emax {

// Whether triangles, their insides included, lie within a distance of a reference surface. "Yes" is
// proven except for roundings of a few units in the last place of the coordinates, which the caller
// subtracts from the limit. "No" may also mean that the budget is spent.
//
// The reference near a triangle T is mostly one sheet over it. From a triangle of the reference
// under the middle of T the sheet is followed through its edges as far as it overlaps T in T's
// projection and faces the same way (SheetWalk). The distance to one triangle of the reference is
// convex, so no point of the part of T that this triangle covers is farther than the farthest
// corner of the part. Likewise for the parts of T that an edge hides at which the sheet ends: at
// creases and borders T hangs over by less than the limit. Parts of which this does not prove
// enough, and all of T where no sheet is under its middle, are halved until each piece is within
// the limit of one triangle of the reference.
//
// O(triangles of the reference over T). Safe for concurrent use, with a Search for each thread.
class BackBound {
 public:
  // `reference` is manifold, consistently oriented and without degenerate triangles.
  BackBound(const TriangleMesh& reference, double limit);
  ~BackBound();

  double limit() const { return limit_; }
  double mean_edge() const { return mean_edge_; }  // length, of the reference
  // Three quarters of the reference's inner edges have a triangle whose far corner is at most so
  // high over the plane of the other.
  double usual_rise() const { return usual_rise_; }
  // Whether the reference is smooth against the limit.
  bool is_smooth() const { return usual_rise_ <= kSmooth * limit(); }
  // Sights taken before keep shares of the former limit.
  void set_limit(double limit) {
    limit_ = limit;
    squared_limit_ = limit * limit;
  }
  const EditableMesh& reference() const { return reference_; }

  // The triangle of the reference that is nearest to a point; kNoIndex beyond twice the limit.
  struct Sight {
    std::uint32_t triangle = kNoIndex;
    double share = 16;  // squared distance / limit^2; 16 where no triangle is near
  };
  Sight sight(const Point& p, std::uint32_t hint = kNoIndex) const;
  // Walks from triangle to triangle through the sides that the point is beyond, as long as the
  // distance decreases. The result may not be the nearest triangle.
  Sight sight_from(const Point& p, std::uint32_t hint) const;
  // Of one triangle of the reference.
  double share_of(const Point& p, std::uint32_t triangle) const;
  // An edge of the reference under a segment: the share of the way where they cross, and the
  // triangles before and behind it.
  struct Crossing {
    double along;
    std::uint32_t before, behind;
  };
  // The edges of the reference that the plane through the segment and `up` cuts, from one end of
  // the segment to the other; from triangle to triangle, where `middle` is the one under the
  // segment's middle. Returns false, with some of them, where the reference has a border or turns
  // back before an end. O(crossings).
  bool follow(const Point& from, const Point& to, const Point& up, std::uint32_t middle,
              std::vector<Crossing>& crossings) const;
  // The vector from a point to the nearest point of a triangle of the reference.
  Point toward(const Point& p, std::uint32_t triangle) const;

  // What one thread needs while it searches; 4 bytes a triangle of the reference.
  struct Search;
  std::shared_ptr<Search> make_search() const;
  // `near` is the triangle of the reference nearest to corners[0].
  bool holds(const std::array<Point, 3>& corners, std::uint32_t near, Search& search) const;

 private:
  static constexpr double kSmooth = 1.5;  // of the limit: the usual rise of a smooth reference

  class Faces;
  class Segment;

  double find_usual_rise() const;
  Sheet follow_sheet(const TrianglePlane& plane, std::uint32_t near, Search& search) const;
  bool part_within(const TrianglePlane& plane, const std::vector<PlanarCorner>& part,
                   std::uint32_t triangle, Search& search) const;
  bool halve(const std::array<Point, 3>& corners, Search& search) const;

  EditableMesh reference_;
  SlotTree tree_;
  double limit_, squared_limit_;
  double mean_edge_ = 0, usual_rise_ = 0;
  // The data of a triangle that following the sheet reads, in one place.
  struct Face {
    Triangle corners;
    std::array<std::uint32_t, 3> neighbours;  // through the side that begins at each corner
  };
  std::vector<Face> faces_;
};

}  // namespace emax
