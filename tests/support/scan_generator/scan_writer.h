#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ostream>
#include <span>

#include "sw_model/base/mesh_view.h"

namespace emax::test {

// Gives the same points every time that it is called.
using PointSource = std::function<void(const std::function<void(std::span<const Point>)>& take)>;

// Writes the points of a source as they come. PLY has 32 bits a coordinate; a stream needs the
// number of points beforehand. LAS 1.2 and E57 have tenths of a millimetre. Throws
// std::runtime_error where the file cannot be written.
void write_ply_scan(std::ostream& to, std::uint64_t count, const PointSource& points);
void write_ply_scan(const std::filesystem::path& file, const PointSource& points);
// The bytes of the file, front to back: `points` is called twice, because the header tells their
// number and box.
void write_las_scan(std::ostream& to, const PointSource& points);
void write_las_scan(const std::filesystem::path& file, const PointSource& points);
void write_e57_scan(const std::filesystem::path& file, const PointSource& points);

}  // namespace emax::test
