#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// The perceptually uniform map "viridis" from dark blue at 0 to yellow at 1 and beyond.
Colour viridis(double position);

// Writes a binary PLY of the points (and triangles over them) with their distances as a property
// "distance", coloured from 0 to `greatest`. The file is written whole or not at all. Throws Error.
void write_error_ply(const std::filesystem::path& path, std::span<const Point> points,
                     std::span<const double> distances, double greatest,
                     std::span<const Triangle> triangles = {});

}  // namespace emax
