#pragma once

#include <filesystem>
#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Writes a binary PLY of the points (and triangles over them) with their distances as a property
// "distance", coloured from 0 to `greatest`. The file is written whole or not at all. Throws Error.
void write_error_ply(const std::filesystem::path& path, std::span<const Point> points,
                     std::span<const double> distances, double greatest,
                     std::span<const Triangle> triangles = {});

}  // namespace emax
