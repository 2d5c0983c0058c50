#pragma once

#include "host/geometry/triangle_mesh.h"

namespace emax {

// How coordinates are kept: as they are, or as STL does, rounded to 32 bit with equal vertices
// merged.
enum class Storage { kExact, kBinary32 };

// The mesh that storing and reading gives back, bit for bit. kBinary32 rounds coordinates, then
// drops unused vertices and merges equal ones in the order of first use; triangles keep their
// number and order, so one that collapses stays, with a repeated index, for check_mesh to report.
// Coordinates are finite. O(n) expected.
TriangleMesh as_stored(const TriangleMesh& mesh, Storage storage);

// The greatest distance by which storing moves a vertex. O(n).
double storage_displacement(const TriangleMesh& mesh, Storage storage);

}  // namespace emax
