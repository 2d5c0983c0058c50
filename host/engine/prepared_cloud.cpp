#include "host/engine/prepared_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace emax {
namespace {

void extend(FloatBox& box, const std::array<float, 3>& lo, const std::array<float, 3>& hi) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], hi[axis]);
  }
}

Eigen::AlignedBox3d widened(const FloatBox& box) {
  return {Point(box.lo[0], box.lo[1], box.lo[2]), Point(box.hi[0], box.hi[1], box.hi[2])};
}

}  // namespace

PreparedCloud::PreparedCloud(std::span<const Point> cloud)
    : PreparedCloud(cloud, normalization_of(cloud)) {}

PreparedCloud::PreparedCloud(std::span<const Point> cloud, const Normalization& normalization)
    : normalization_(normalization), points_(normalized_points(cloud, normalization)) {
  const std::size_t packets = (points_.size() + kPacketPoints - 1) / kPacketPoints;
  packets_.reserve(packets);
  boxes_.reserve(packets);
  groups_.reserve(packets);
  std::vector<IndexedPoint> points;
  points.reserve(points_.size());
  for (const Vector3<float>& p : points_) {
    points.push_back({{p.x, p.y, p.z}, static_cast<std::uint32_t>(points.size())});
  }
  split(points);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (i % kSupergroupPackets == 0) supergroups_.push_back(boxes_[i]);
    add_ball(i);
    extend(supergroups_.back(), boxes_[i].lo, boxes_[i].hi);
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

// Splits at the median of the longest side of the box, first at whole supergroups, then at whole
// packets. Equal coordinates are ordered by index, so the packets are the same with every standard
// library.
void PreparedCloud::split(std::span<IndexedPoint> points) {
  FloatBox box = {points.front().at, points.front().at};
  for (const IndexedPoint& p : points) extend(box, p.at, p.at);
  if (points.size() <= kPacketPoints) {
    add_packet(points, box);
    return;
  }
  Eigen::Index longest = 0;
  widened(box).sizes().maxCoeff(&longest);
  const auto axis = static_cast<std::size_t>(longest);
  constexpr std::size_t kSupergroupPoints = kSupergroupPackets * kPacketPoints;
  const std::size_t unit = points.size() > kSupergroupPoints ? kSupergroupPoints : kPacketPoints;
  const std::size_t middle = (points.size() + unit - 1) / unit / 2 * unit;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle),
                   points.end(), [axis](const IndexedPoint& a, const IndexedPoint& b) {
                     return a.at[axis] < b.at[axis] ||
                            (a.at[axis] == b.at[axis] && a.index < b.index);
                   });
  split(points.first(middle));
  split(points.subspan(middle));
}

void PreparedCloud::add_packet(std::span<IndexedPoint> points, const FloatBox& box) {
  std::ranges::sort(points, {}, &IndexedPoint::index);
  Packet& packet = packets_.emplace_back();
  for (std::size_t i = 0; i < kPacketPoints; ++i) {
    const IndexedPoint& p = points[std::min(i, points.size() - 1)];
    packet.index[i] = p.index;
    packet.x[i] = p.at[0];
    packet.y[i] = p.at[1];
    packet.z[i] = p.at[2];
  }
  groups_.push_back({std::span(packet.index).first(points.size()), widened(box)});
  boxes_.push_back(box);
}

std::size_t PreparedCloud::memory_bytes() const {
  return std::span(points_).size_bytes() + std::span(packets_).size_bytes() +
         std::span(boxes_).size_bytes() + std::span(supergroups_).size_bytes() +
         std::span(balls_).size_bytes() + std::span(groups_).size_bytes();
}

}  // namespace emax
