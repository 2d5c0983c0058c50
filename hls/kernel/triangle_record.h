// The triangle record: everything the kernel knows of a triangle, 20 words of 32 bits.
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

constexpr std::uint32_t kRecordWords = 20;
constexpr std::uint32_t kSegmentFlag = 0x80000000u;
constexpr std::uint32_t kMaxTriangles = kSegmentFlag;

static_assert(sizeof(TriangleRecord<float>) == kRecordWords * 4,
              "a record is 20 words without padding: 3 + 9 + 1 + 3 + 3 + 1");

}  // namespace emax

#endif
