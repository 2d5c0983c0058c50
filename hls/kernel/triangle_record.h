// The triangle record: a triangle as the kernel reads it, 20 words of 32 bits.
//
// The record holds the translation and rotation that put V1 on the origin, V2 on the z axis and V3
// in the yz plane (paper, section 4), so that the distance becomes a problem in two dimensions.
// V1V2 is the longest edge. Lengths are in normalised units; directions have unit length.
#ifndef EMAX_HLS_KERNEL_TRIANGLE_RECORD_H
#define EMAX_HLS_KERNEL_TRIANGLE_RECORD_H

#include <cstdint>

#include "hls/kernel/scalar.h"

namespace emax {

// An edge as seen in the plane: unit direction and length.
template <class Scalar>
struct PlanarEdge {
  Vector2<Scalar> direction;
  Scalar length;
};

template <class Scalar>
struct TriangleRecord {
  Vector3<Scalar> v1;
  Vector3<Scalar> normal;    // rows of the rotation: x, the plane normal,
  Vector3<Scalar> in_plane;  // y, in the plane, from V1V2 towards V3,
  Vector3<Scalar> along;     // z, from V1 to V2
  Scalar length12;
  PlanarEdge<Scalar> edge13;
  PlanarEdge<Scalar> edge23;
  std::uint32_t tag;  // index of the triangle, kSegmentFlag in the highest bit
};

// Calls visit for each scalar of records of the same triangle, in the order of a record's words:
// visit(a.v1.x, b.v1.x) to visit(a.edge23.length, b.edge23.length). The last word is the tag.
// All code that reads, writes, names or converts the words takes their order from here.
template <class Visit, class... Records>
void for_each_scalar(const Visit& visit, Records&... records) {
  visit(records.v1.x...);
  visit(records.v1.y...);
  visit(records.v1.z...);
  visit(records.normal.x...);
  visit(records.normal.y...);
  visit(records.normal.z...);
  visit(records.in_plane.x...);
  visit(records.in_plane.y...);
  visit(records.in_plane.z...);
  visit(records.along.x...);
  visit(records.along.y...);
  visit(records.along.z...);
  visit(records.length12...);
  visit(records.edge13.direction.y...);
  visit(records.edge13.direction.z...);
  visit(records.edge13.length...);
  visit(records.edge23.direction.y...);
  visit(records.edge23.direction.z...);
  visit(records.edge23.length...);
}

constexpr std::uint32_t kRecordWords = 20;
// The names of the words, for reports and for the ports of the datapath.
constexpr const char* kRecordWordNames[kRecordWords] = {"v1_x",
                                                        "v1_y",
                                                        "v1_z",
                                                        "normal_x",
                                                        "normal_y",
                                                        "normal_z",
                                                        "in_plane_x",
                                                        "in_plane_y",
                                                        "in_plane_z",
                                                        "along_x",
                                                        "along_y",
                                                        "along_z",
                                                        "length12",
                                                        "edge13_direction_y",
                                                        "edge13_direction_z",
                                                        "edge13_length",
                                                        "edge23_direction_y",
                                                        "edge23_direction_z",
                                                        "edge23_length",
                                                        "tag"};
constexpr std::uint32_t kSegmentFlag = 0x80000000u;
constexpr std::uint32_t kMaxTriangles = kSegmentFlag;

static_assert(sizeof(TriangleRecord<float>) == kRecordWords * 4,
              "a record is 20 words without padding: 3 + 9 + 1 + 3 + 3 + 1");

}  // namespace emax

#endif
