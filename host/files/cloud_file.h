#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "host/geometry/point_cloud.h"

namespace emax {

struct CloudReadOptions {
  // Leave out points with a NaN or infinite coordinate instead of refusing the file;
  // PointCloud::file_index then holds the indices in the file of those that are left.
  bool skip_invalid = false;
};

// The endings that read_cloud knows: .ply .pcd .xyz .asc .txt .pts .obj .off.
std::span<const std::string_view> cloud_endings();

// Reads a cloud by the ending of `path`. Coordinates are those of the file to the last bit: text is
// rounded once to 64 bit. The vertices of a mesh file are the cloud. Normals are kept when the file
// has them for every point and all are finite and not zero; others are none at all, to be
// estimated. Throws Error for anything that is not exactly what its format promises: nothing is
// guessed, nothing missing is filled in, and nothing is allocated for a count that the file cannot
// hold.
PointCloud read_cloud(const std::filesystem::path& path, const CloudReadOptions& options = {});

// Throws Error naming `file` when nothing can be reconstructed from the cloud: fewer than 4 points,
// all equal or on one line. A plane is a surface. On a line means to within the greater of 1e-9 of
// the cloud's extent and 8 roundings of its greatest coordinate, so that a tilted line far from the
// origin, which rounding has roughened, counts as one. Duplicates are fine. O(n).
void check_cloud(const PointCloud& cloud, std::string_view file);

}  // namespace emax
