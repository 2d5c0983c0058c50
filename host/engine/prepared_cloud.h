#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "host/engine/packets.h"
#include "sw_model/model/normalization.h"

namespace emax {

// Neighbouring points that the search handles together.
struct PointGroup {
  std::span<const std::uint32_t> points;  // indices into the cloud, ascending
  Eigen::AlignedBox3d box;                // of the points as the kernel reads them
};

// The form of a cloud that the search reads, made once: normalised points, and packets of
// kPacketPoints neighbours, each of which is a group. O(n log^2 n) time, 35 bytes a point.
class PreparedCloud {
 public:
  static constexpr std::size_t kGroupPoints = kPacketPoints;

  // Throws std::invalid_argument as normalization_of does.
  explicit PreparedCloud(std::span<const Point> cloud);
  // Of some points of a cloud, which is normalised as a whole.
  PreparedCloud(std::span<const Point> points, const Normalization& normalization);

  const Normalization& normalization() const { return normalization_; }
  std::span<const Vector3<float>> points() const { return points_; }
  std::span<const PointGroup> groups() const { return groups_; }
  PacketView packets() const { return {packets_, boxes_, supergroups_, balls_}; }
  std::size_t memory_bytes() const;

 private:
  struct IndexedPoint {
    std::array<float, 3> at;
    std::uint32_t index;
  };
  void split(std::span<IndexedPoint> points);
  void add_packet(std::span<IndexedPoint> points, const FloatBox& box);
  void add_ball(std::size_t packet);

  Normalization normalization_;
  std::vector<Vector3<float>> points_;
  std::vector<Packet> packets_;
  std::vector<FloatBox> boxes_, supergroups_;
  std::vector<PacketBalls> balls_;
  std::vector<PointGroup> groups_;
};

}  // namespace emax
