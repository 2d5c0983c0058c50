#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax {

// How coordinates are kept: unchanged, or as STL keeps them, rounded to 32 bits with equal vertices
// merged.
enum class Storage { kExact, kBinary32 };

// The mesh that storing and reading gives back, bit for bit. kBinary32 rounds coordinates, then
// drops unused vertices and merges equal ones in the order of first use. Triangles keep their
// number and order: a triangle that collapses stays with a repeated index, which check_mesh
// reports. Coordinates are finite. O(n) expected.
TriangleMesh as_stored(const TriangleMesh& mesh, Storage storage);

// The greatest distance by which storing moves a vertex. O(n).
double storage_displacement(const TriangleMesh& mesh, Storage storage);

}  // namespace emax
