#include "sw_model/triangle_frame.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sw_model/error.h"
#include "sw_model/flush_mode.h"

namespace emax {
namespace {

// Shorter than this, normalised, squares of lengths underflow and no frame has a meaning: a
// segment.
constexpr double kSmallestLength = 0x1p-500;

// Any unit vector across `axis`, the same one for the same axis.
Point across(const Point& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Point::Unit(least)).normalized();
}

// Eigen's normalized() leaves a zero vector zero and underflows on tiny ones; scaling first keeps
// the direction of an edge of any length.
Point direction(const Point& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0 ? Point((v / largest).normalized()) : Point(Point::UnitZ());
}

Eigen::Vector2d planar_direction(const Eigen::Vector2d& v, double length) {
  return length > 0 ? Eigen::Vector2d((v / length).normalized()) : Eigen::Vector2d(0, 1);
}

Vector3<float> rounded(const Point& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

PlanarEdge<float> rounded(const Eigen::Vector2d& direction, double length) {
  return {{static_cast<float>(direction.x()), static_cast<float>(direction.y())},
          static_cast<float>(length)};
}

}  // namespace

TriangleFrame make_frame(const std::array<Point, 3>& corners) {
  std::size_t first = 0;  // of the longest edge, in file order
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double squared = (corners[(i + 1) % 3] - corners[i]).squaredNorm();
    if (squared > longest) {
      longest = squared;
      first = i;
    }
  }
  const Point to2 = corners[(first + 1) % 3] - corners[first];
  const Point to3 = corners[(first + 2) % 3] - corners[first];

  TriangleFrame frame;
  frame.v1 = corners[first];
  frame.length12 = to2.stableNorm();
  frame.along = direction(to2);
  const Point off_axis = to3 - frame.along.dot(to3) * frame.along;
  const double height = off_axis.stableNorm();
  frame.segment = !(height >= kSliverRatio * frame.length12) || frame.length12 < kSmallestLength;
  // Orthogonalised twice: once leaves a cancellation error of the size of the sliver ratio.
  frame.in_plane = frame.segment ? across(frame.along) : direction(off_axis);
  frame.in_plane = (frame.in_plane - frame.along.dot(frame.in_plane) * frame.along).normalized();
  frame.normal = frame.in_plane.cross(frame.along).normalized();

  frame.v3 = {frame.in_plane.dot(to3), frame.along.dot(to3)};
  const Eigen::Vector2d edge23 = frame.v3 - Eigen::Vector2d(0, frame.length12);
  frame.length13 = frame.v3.stableNorm();
  frame.length23 = edge23.stableNorm();
  frame.direction13 = planar_direction(frame.v3, frame.length13);
  frame.direction23 = planar_direction(edge23, frame.length23);
  return frame;
}

TriangleRecord<float> make_record(const TriangleFrame& frame, std::uint32_t triangle) {
  if (triangle >= kMaxTriangles) throw std::invalid_argument("a triangle index needs 31 bits");
  const TriangleRecord<float> record = {rounded(frame.v1),
                                        rounded(frame.normal),
                                        rounded(frame.in_plane),
                                        rounded(frame.along),
                                        static_cast<float>(frame.length12),
                                        rounded(frame.direction13, frame.length13),
                                        rounded(frame.direction23, frame.length23),
                                        triangle | (frame.segment ? kSegmentFlag : 0)};
  const double reach = frame.v1.cwiseAbs().maxCoeff() + frame.length12;
  if (!(reach <= 4 * kMaxNormalizedCoordinate) || !frame.normal.allFinite() ||
      !frame.v3.allFinite()) {
    throw std::invalid_argument("a triangle record must be finite");
  }
  return record;
}

BarycentricRecord<float> make_barycentric_record(const TriangleFrame& frame,
                                                 std::uint32_t triangle) {
  const auto inverse = [](double value) {
    return value > 0 ? static_cast<float>(1 / value) : 0.0f;
  };
  return {make_record(frame, triangle),
          {static_cast<float>(frame.v3.x()), static_cast<float>(frame.v3.y())},
          frame.segment ? 0.0f : inverse(frame.length12 * frame.v3.x()),
          inverse(frame.length12 * frame.length12),
          inverse(frame.length13 * frame.length13),
          inverse(frame.length23 * frame.length23)};
}

std::vector<TriangleRecord<float>> make_records(MeshView mesh, const Normalization& normalization) {
  require_no_flush("making triangle frames");
  std::vector<TriangleRecord<float>> records;
  records.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Point, 3> corners = mesh.corners(i);
    for (Point& corner : corners) {
      corner = normalization.apply(corner);
      if (!(corner.array().abs() <= kMaxNormalizedCoordinate).all()) {
        throw Error("triangle " + std::to_string(i) +
                    " has a vertex that is not finite or is 2^32 times the cloud's size away; "
                    "mesh and cloud must be in one coordinate system");
      }
    }
    records.push_back(make_record(make_frame(corners), static_cast<std::uint32_t>(i)));
  }
  return records;
}

}  // namespace emax
