#include "sw_model/model/triangle_frame.h"

#include <stdexcept>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/model/frame_arithmetic.h"

namespace emax {
namespace {

Point eigen(const Vector3<double>& v) { return {v.x, v.y, v.z}; }
Eigen::Vector2d eigen(const Vector2<double>& v) { return {v.y, v.z}; }

Vector3<float> rounded(const Point& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

PlanarEdge<float> rounded(const Eigen::Vector2d& direction, double length) {
  return {{static_cast<float>(direction.x()), static_cast<float>(direction.y())},
          static_cast<float>(length)};
}

}  // namespace

TriangleFrame make_frame(const std::array<Point, 3>& corners) {
  std::array<Vector3<double>, 3> vectors{};
  for (std::size_t i = 0; i < 3; ++i) vectors[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
  const auto frame = frame_of(vectors);
  return {eigen(frame.v1),
          eigen(frame.normal),
          eigen(frame.in_plane),
          eigen(frame.along),
          frame.length12,
          frame.length13,
          frame.length23,
          eigen(frame.direction13),
          eigen(frame.direction23),
          eigen(frame.v3),
          frame.segment};
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
