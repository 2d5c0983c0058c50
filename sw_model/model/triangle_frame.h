#pragma once

#include <vector>

#include "hls/kernel/forms/barycentric.h"
#include "sw_model/base/mesh_view.h"
#include "sw_model/model/frame_arithmetic.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The frame of a triangle in double, before its one rounding to what the kernel reads: the
// translation and rotation that put V1 on the origin, V2 on the z axis and V3 in the yz plane
// (paper, section 4).
//
// V1V2 is the longest edge; ties go to the first of V1V2, V2V3, V3V1 in file order, by squared
// length in double. A triangle whose height over that edge is below kSliverRatio of its length is a
// segment; one whose vertices are all equal is a segment of length 0.
using TriangleFrame = FrameOf<double, bool>;

inline Point eigen(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

// Corners in normalised units. O(1).
TriangleFrame make_frame(const std::array<Point, 3>& corners);

// Rounds a frame to what the kernel reads. Throws std::invalid_argument where a field would not be
// finite or the triangle index does not fit.
TriangleRecord<float> make_record(const TriangleFrame& frame, std::uint32_t triangle);

// The same triangle for the paper's literal (u, v) form.
BarycentricRecord<float> make_barycentric_record(const TriangleFrame& frame,
                                                 std::uint32_t triangle);

// Records of all triangles of a mesh given in file units, in file order. Throws Error naming the
// triangle where a vertex is not finite or lies beyond kMaxNormalizedCoordinate. O(n).
std::vector<TriangleRecord<float>> make_records(MeshView mesh, const Normalization& normalization);

}  // namespace emax
