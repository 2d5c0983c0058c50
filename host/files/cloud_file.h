#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/geometry/point_cloud.h"

namespace emax {

class LasStream;

struct CloudReadOptions {
  // Leaves out points with a NaN or infinite coordinate instead of refusing the file.
  // PointCloud::file_index then holds the indices in the file of the points that are left.
  bool skip_invalid = false;
  // Leaves out the points of these classes. Only LAS and LAZ have classes; for a file of another
  // format they are an Error.
  std::vector<std::uint8_t> left_out_classes = {};

  bool operator==(const CloudReadOptions&) const = default;
};

// The endings that read_cloud knows: .ply .pcd .xyz .asc .txt .pts .obj .off .las .laz .e57 .ptx
// .glb .3mf.
std::span<const std::string_view> cloud_endings();

// Reads a cloud by the ending of `path`. Coordinates are those of the file to the last bit: text is
// rounded once to 64 bits. The vertices of a mesh file are the cloud. Normals are kept if the file
// has them for every point and all are finite and not zero; otherwise the cloud has none, and they
// are estimated. Throws Error where the file does not keep exactly to its format. Nothing is
// guessed, nothing missing is filled in, and nothing is allocated for a count that the file cannot
// hold. Points that a file marks as invalid or empty are left out and counted. The poses of scans
// are applied. LAS, LAZ and E57 files are read in pieces. A folder is read as one cloud
// (scan_folder.h); `path` may be compressed or standard input as InputStream's may.
PointCloud read_cloud(const std::filesystem::path& path, const CloudReadOptions& options = {});

// Which pieces of a cloud are wanted.
struct PieceChoice {
  // Asked once for each piece, in their order; nothing: all are. A piece that is not wanted is
  // given without points (PointCloud::unwanted).
  std::function<bool()> wants = nullptr;
  // Nothing in the file is left out, as is known of one that was read before. Pieces of
  // uncompressed binary PLY, PCD and LAS files that are not wanted are not read then.
  bool is_complete = false;
};

// As read_cloud(), but gives the points to `take` in file order, `piece_points` or fewer at a time,
// and holds no more of them; without normals. Returns the rest of what the file says, without
// points and scans. Files of .obj .off .glb .3mf and compressed .pcd
// are held whole.
PointCloud read_cloud_in_pieces(const std::filesystem::path& path, const CloudReadOptions& options,
                                std::size_t piece_points,
                                const std::function<void(PointCloud)>& take,
                                const PieceChoice& choice = {});

// The same of a stream, which is read to its end.
PointCloud read_cloud_in_pieces(LasStream& stream, const CloudReadOptions& options,
                                std::size_t piece_points,
                                const std::function<void(PointCloud)>& take,
                                const PieceChoice& choice = {});

// "120 empty cells, 3 not finite"
std::string describe(const std::vector<LeftOut>& left_out);

// Throws Error naming `file` if no surface can be reconstructed from the cloud: it has fewer than 4
// points, or all points are equal or on one line. A plane is a surface. Points are on a line if
// they are within the greater of 1e-9 of the cloud's extent and 8 roundings of its greatest
// coordinate, so that a tilted line far from the origin counts despite its roundings. Duplicates
// are permitted. O(n).
void check_cloud(const PointCloud& cloud, std::string_view file);

}  // namespace emax
