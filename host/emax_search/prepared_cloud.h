#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "sw_model/normalization.h"

namespace emax {

// Neighbouring points that are judged together.
struct PointGroup {
  std::span<const std::uint32_t> points;  // indices into the cloud, ascending
  Eigen::AlignedBox3d box;                // of the points as the kernel reads them
};

// What the search needs of a cloud, made once: normalised points and groups of at most
// kGroupPoints neighbours. O(n log^2 n) time, 24 bytes a point.
class PreparedCloud {
 public:
  static constexpr std::size_t kGroupPoints = 16;

  // Throws std::invalid_argument as normalization_of does.
  explicit PreparedCloud(std::span<const Point> cloud);

  const Normalization& normalization() const { return normalization_; }
  std::span<const Vector3<float>> points() const { return points_; }
  std::span<const PointGroup> groups() const { return groups_; }

 private:
  void split(std::size_t first, std::size_t last);
  Eigen::AlignedBox3d box_of(std::size_t first, std::size_t last) const;

  Normalization normalization_;
  std::vector<Vector3<float>> points_;
  std::vector<std::uint32_t> order_;
  std::vector<PointGroup> groups_;
};

}  // namespace emax
