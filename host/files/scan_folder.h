#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/files/cloud_file.h"

namespace emax {

// The clouds of a folder: its regular files whose names have an ending of cloud_endings(), .gz and
// .zst included, and do not begin with a dot, in the order of the bytes of their names. Folders in
// it are left alone. Throws Error if there are none.
std::vector<std::filesystem::path> scans_in(const std::filesystem::path& folder);

// The clouds of a folder as one, one after the other. The index of a point is its place among all
// points of all files. Every file is a scan, or, where it has scans of its own, each of those,
// named "file/scan". Throws Error naming the file that cannot be read, and where the units differ.
PointCloud read_scan_folder(const std::filesystem::path& folder, const CloudReadOptions& options);

// The same in pieces, as read_cloud_in_pieces().
PointCloud read_scan_folder_in_pieces(const std::filesystem::path& folder,
                                      const CloudReadOptions& options, std::size_t piece_points,
                                      const std::function<void(PointCloud)>& take,
                                      const PieceChoice& choice = {});

// The SHA-256 of the lines that `sha256sum` prints for these files in the folder: it holds their
// names, too.
std::string sha256_of_folder(const std::filesystem::path& folder);

// The bytes of an input: a file, a folder of scans or standard input. Throws Error.
std::uint64_t bytes_of_input(const std::filesystem::path& path);
// The last part of the path, for a folder without the slash behind it.
std::string name_of_input(const std::filesystem::path& path);

}  // namespace emax
