#pragma once

#include <filesystem>

#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// A mesh as two files that every language reads in one call: binary64 coordinates and 32-bit
// indices, three to a row, in this machine's byte order.
inline constexpr const char* kVertexFile = "vertices.f64";
inline constexpr const char* kTriangleFile = "triangles.u32";

void write_raw(const std::filesystem::path& folder, const TriangleMesh& mesh);

// Throws Error unless the files hold a mesh: whole rows, finite coordinates, indices of vertices.
TriangleMesh read_raw(const std::filesystem::path& folder);

}  // namespace emax::benchmarks
