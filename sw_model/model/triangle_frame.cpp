#include "sw_model/model/triangle_frame.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/model/frame_arithmetic.h"

namespace emax {
TriangleFrame make_frame(const std::array<Point, 3>& corners) {
  std::array<Vector3<double>, 3> vectors{};
  for (std::size_t i = 0; i < 3; ++i) vectors[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
  return frame_of(vectors);
}

TriangleRecord<float> make_record(const TriangleFrame& frame, std::uint32_t triangle) {
  if (triangle >= kMaxTriangles) throw std::invalid_argument("a triangle index needs 31 bits");
  TriangleRecord<float> record{};
  for_each_scalar([](float& word, const double& exact) { word = static_cast<float>(exact); },
                  record, frame.record);
  record.tag = triangle | (frame.segment ? kSegmentFlag : 0);
  const double reach = eigen(frame.record.v1).cwiseAbs().maxCoeff() + frame.record.length12;
  if (!(reach <= 4 * kMaxNormalizedCoordinate) || !eigen(frame.record.normal).allFinite() ||
      !std::isfinite(frame.v3.y) || !std::isfinite(frame.v3.z)) {
    throw std::invalid_argument("a triangle record must be finite");
  }
  return record;
}

BarycentricRecord<float> make_barycentric_record(const TriangleFrame& frame,
                                                 std::uint32_t triangle) {
  const TriangleRecord<double>& r = frame.record;
  const auto inverse = [](double value) {
    return value > 0 ? static_cast<float>(1 / value) : 0.0f;
  };
  return {make_record(frame, triangle),
          {static_cast<float>(frame.v3.y), static_cast<float>(frame.v3.z)},
          frame.segment ? 0.0f : inverse(r.length12 * frame.v3.y),
          inverse(r.length12 * r.length12),
          inverse(r.edge13.length * r.edge13.length),
          inverse(r.edge23.length * r.edge23.length)};
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
