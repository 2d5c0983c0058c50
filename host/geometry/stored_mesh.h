#pragma once

#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// How a format keeps a mesh.
enum class Storage {
  kExact,     // unchanged
  kMerged,    // coordinates unchanged; unused vertices dropped and equal ones merged
  kBinary32,  // coordinates rounded to 32 bits, then as kMerged: STL
  // Each vertex is the 64-bit sum of storage_origin() and 32-bit coordinates relative to it: GLB.
  // A negative zero becomes zero.
  kShiftedBinary32,
};

// The lower corner of the box around the vertices, or the origin if there are none.
Point storage_origin(std::span<const Point> vertices);

// The mesh that storing and reading gives back, bit for bit; storing that mesh gives it again.
// Merging numbers vertices in the order of first use. Triangles keep their number and order: a
// triangle that collapses stays with a repeated index, which check_mesh reports. Coordinates are
// finite. O(n) expected.
TriangleMesh as_stored(const TriangleMesh& mesh, Storage storage);

// The greatest distance by which storing moves a vertex. O(n).
double storage_displacement(const TriangleMesh& mesh, Storage storage);

}  // namespace emax
