#include "host/emax_search/prepared_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace emax {
namespace {

Point widened(const Vector3<float>& p) { return {p.x, p.y, p.z}; }

}  // namespace

PreparedCloud::PreparedCloud(std::span<const Point> cloud)
    : normalization_(normalization_of(cloud)), points_(normalized_points(cloud, normalization_)) {
  const std::size_t packets = (points_.size() + kPacketPoints - 1) / kPacketPoints;
  packets_.reserve(packets);
  boxes_.reserve(packets);
  groups_.reserve(packets);
  std::vector<std::uint32_t> order(points_.size());
  std::iota(order.begin(), order.end(), 0u);
  split(order);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (i % kSupergroupPackets == 0) supergroups_.push_back(boxes_[i]);
    add_ball(i);
    FloatBox& box = supergroups_.back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], boxes_[i].lo[axis]);
      box.hi[axis] = std::max(box.hi[axis], boxes_[i].hi[axis]);
    }
  }
}

void PreparedCloud::add_ball(std::size_t packet) {
  const std::size_t lane = packet % kSupergroupPackets;
  if (lane == 0) {
    balls_.emplace_back();
    balls_.back().radius.fill(std::numeric_limits<float>::infinity());
  }
  PacketBalls& balls = balls_.back();
  const Packet& points = packets_[packet];
  const Point centre = groups_[packet].box.center().cast<float>().cast<double>();
  double radius = 0;
  for (std::size_t i = 0; i < kPacketPoints; ++i) {
    radius = std::max(radius, (Point(points.x[i], points.y[i], points.z[i]) - centre).norm());
  }
  balls.x[lane] = static_cast<float>(centre.x());
  balls.y[lane] = static_cast<float>(centre.y());
  balls.z[lane] = static_cast<float>(centre.z());
  balls.radius[lane] =
      std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
}

Eigen::AlignedBox3d PreparedCloud::box_of(std::span<const std::uint32_t> order) const {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t i : order) box.extend(widened(points_[i]));
  return box;
}

// A kd-split at the median of the longest side, at whole supergroups, then at whole packets. Equal
// coordinates are ordered by index, so the packets are the same with every standard library.
void PreparedCloud::split(std::span<std::uint32_t> order) {
  const Eigen::AlignedBox3d box = box_of(order);
  if (order.size() <= kPacketPoints) {
    std::sort(order.begin(), order.end());
    add_packet(order, box);
    return;
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  constexpr std::size_t kSupergroupPoints = kSupergroupPackets * kPacketPoints;
  const std::size_t unit = order.size() > kSupergroupPoints ? kSupergroupPoints : kPacketPoints;
  const std::size_t middle = (order.size() + unit - 1) / unit / 2 * unit;
  const auto key = [&](std::uint32_t i) { return std::pair(widened(points_[i])[axis], i); };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  split(order.first(middle));
  split(order.subspan(middle));
}

void PreparedCloud::add_packet(std::span<std::uint32_t> order, const Eigen::AlignedBox3d& box) {
  Packet& packet = packets_.emplace_back();
  for (std::size_t i = 0; i < kPacketPoints; ++i) {
    packet.index[i] = order[std::min(i, order.size() - 1)];
    const Vector3<float>& p = points_[packet.index[i]];
    packet.x[i] = p.x;
    packet.y[i] = p.y;
    packet.z[i] = p.z;
  }
  groups_.push_back({std::span(packet.index).first(order.size()), box});
  FloatBox& bounds = boxes_.emplace_back();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {  // exact: the corners are binary32
    bounds.lo[static_cast<std::size_t>(axis)] = static_cast<float>(box.min()[axis]);
    bounds.hi[static_cast<std::size_t>(axis)] = static_cast<float>(box.max()[axis]);
  }
}

std::size_t PreparedCloud::memory_bytes() const {
  return std::span(points_).size_bytes() + std::span(packets_).size_bytes() +
         std::span(boxes_).size_bytes() + std::span(supergroups_).size_bytes() +
         std::span(balls_).size_bytes() + std::span(groups_).size_bytes();
}

}  // namespace emax
