#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/files/cloud_file.h"
#include "host/files/input_file.h"
#include "host/geometry/point_cloud.h"
#include "host/geometry/triangle_mesh.h"
#include "host/geometry/unit.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

inline constexpr std::string_view kColours = "colours";
inline constexpr std::string_view kNormals = "normals";
inline constexpr std::string_view kTextureCoordinates = "texture coordinates";
inline constexpr std::string_view kGroups = "groups";
inline constexpr std::string_view kMaterials = "materials";

// The content of a file of any format. Coordinates may be NaN or infinite; `first_invalid` names
// the first such vertex, and the readers of clouds and meshes decide what follows from it.
struct FileContent {
  std::vector<Point> vertices;
  std::vector<Point> normals;       // empty, or one per vertex
  std::vector<Triangle> triangles;  // polygons as fans around their first vertex
  // For each fan of more than one triangle: its first triangle and the number of its triangles.
  std::vector<std::pair<std::size_t, std::size_t>> fans;
  std::string first_invalid;  // "line 12" or "vertex 5"; empty when all are finite
  // Other attributes of the mesh in the file, each once: kColours and the like, or a name from the
  // file.
  std::vector<std::string> attributes;
  // As in PointCloud.
  std::vector<std::uint32_t> file_index;
  std::vector<ScanPart> scans;
  std::vector<LeftOut> left_out;
  std::optional<Unit> unit;
  double resolution = 0;
  bool has_classes = false;  // the format gives each point a class
  // A mesh is read with vertices of equal coordinates merged.
  bool repeats_vertices = false;
  // Of a part: the numbers of its vertices in the file, where these have numbers.
  std::vector<std::uint32_t> vertex_numbers;

  // Gives the points to `take` as they come, at most `points` at a time, and holds no more than
  // these; normals and triangles are not kept.
  void take_pieces(std::size_t points, std::function<void(FileContent&)> take,
                   PieceChoice chosen = {}) {
    piece_points = points;
    take_piece = std::move(take);
    choice = std::move(chosen);
  }
  bool points_only() const { return take_piece != nullptr; }
  void give_piece() {
    if (vertices.empty()) return;
    points_given += vertices.size();
    take_piece(*this);
    is_wanted.reset();
    vertices.clear();
    file_index.clear();
    if (points_expected > points_given) expect_points(points_expected - points_given);
  }
  bool wants_piece() {
    if (!is_wanted) is_wanted = !choice.wants || choice.wants();
    return *is_wanted;
  }
  // How many of the next `left` points need not be read. They are given as a piece without points.
  std::uint64_t pass_unwanted(std::uint64_t left) {
    if (!choice.is_complete || !vertices.empty() || wants_piece()) return 0;
    const std::uint64_t passed = std::min<std::uint64_t>(left, piece_points);
    points_given += passed;
    points_passed = passed;
    take_piece(*this);
    points_passed = 0;
    is_wanted.reset();
    return passed;
  }
  // Gives the triangles to `take` as they come, `most` or a few more at a time, with the vertices
  // of these alone, and holds no more of them. For the readers of MeshParts.
  void take_parts(std::size_t most, std::function<void(FileContent&)> take) {
    part_triangles = most;
    take_part = std::move(take);
  }
  bool is_in_parts() const { return take_part != nullptr; }
  bool part_is_full() const { return triangles.size() >= part_triangles; }
  void give_part() {
    if (triangles.empty()) return;
    take_part(*this);
    vertices.clear();
    triangles.clear();
    fans.clear();
    vertex_numbers.clear();
  }
  // The points that the piece has room for.
  std::size_t room() const { return piece_points - vertices.size(); }
  // Takes the content of a file that was read whole.
  void take(FileContent whole);
  // The points that were added so far.
  std::uint64_t points() const { return points_given + vertices.size(); }
  // That many points follow.
  void expect_points(std::uint64_t count) {
    points_expected = points_given + count;
    vertices.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(count, piece_points)));
  }

  void add_vertex(const Point& point, std::string_view place, std::uint64_t number) {
    if (first_invalid.empty() && !point.allFinite()) {
      first_invalid = std::string(place) + ' ' + std::to_string(number);
    }
    if (left_out_points > 0) file_index.push_back(index_of_next());
    vertices.push_back(point);
    if (vertices.size() == piece_points) give_piece();
  }

  // The next point of the file is left out.
  void leave_out(std::string_view reason) {
    if (left_out_points == 0) {
      file_index.resize(vertices.size());
      std::iota(file_index.begin(), file_index.end(), static_cast<std::uint32_t>(points_given));
    }
    ++left_out_points;
    const auto known = std::ranges::find(left_out, reason, &LeftOut::reason);
    if (known != left_out.end()) {
      ++known->points;
    } else {
      left_out.push_back({std::string(reason), 1});
    }
  }

  // The index in the file of the point that is added or left out next.
  std::uint32_t index_of_next() const {
    return static_cast<std::uint32_t>(points() + left_out_points);
  }

  std::uint64_t left_out_points = 0;
  std::uint64_t points_given = 0;
  std::uint64_t points_expected = 0;
  std::size_t piece_points = std::numeric_limits<std::size_t>::max();
  std::function<void(FileContent&)> take_piece;
  std::size_t part_triangles = std::numeric_limits<std::size_t>::max();
  std::function<void(FileContent&)> take_part;
  PieceChoice choice;
  std::optional<bool> is_wanted;    // the piece that is read, once that was asked
  std::uint64_t points_passed = 0;  // those of a piece that is given without having been read

  void note_attribute(std::string_view name) {
    if (std::ranges::find(attributes, name) == attributes.end()) attributes.emplace_back(name);
  }
};

// The mesh of a content that was read: its vertices are finite, polygons are cut and repeated
// vertices merged. Throws Error.
TriangleMesh take_mesh(const NamedInput& input, FileContent& content);

// Adds the fan of `polygon`. Calls `fail(what)` if it has fewer than three corners or a corner that
// is not in [0, vertex_count).
template <class Fail>
void add_polygon(FileContent& content, std::span<const std::int64_t> polygon,
                 std::uint64_t vertex_count, const Fail& fail) {
  if (polygon.size() < 3) {
    fail("a face of " + std::to_string(polygon.size()) + " corners, fewer than 3");
  }
  for (const std::int64_t corner : polygon) {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertex_count) {
      fail("vertex index " + std::to_string(corner) + " is outside 0.." +
           std::to_string(vertex_count) + " - 1");
    }
  }
  if (content.points_only()) return;
  const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(polygon[i]); };
  if (polygon.size() > 3) content.fans.emplace_back(content.triangles.size(), polygon.size() - 2);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    content.triangles.push_back({index(0), index(i - 1), index(i)});
  }
}

// Adds the triangles of strips of at least three corners each; -1 separates strips. Every second
// triangle of a strip is turned, so that all face the same way. Triangles that repeat a corner only
// connect strips and are left out. `fail` is called as above.
template <class Fail>
void add_strips(FileContent& content, std::span<const std::int64_t> corners,
                std::uint64_t vertex_count, const Fail& fail) {
  for (std::size_t begin = 0; begin < corners.size();) {
    std::size_t end = begin;
    while (end < corners.size() && corners[end] != -1) ++end;
    if (end != begin && end - begin < 3) {
      fail("a strip of " + std::to_string(end - begin) + " corners, fewer than 3");
    }
    for (std::size_t i = begin + 2; i < end; ++i) {
      std::array<std::int64_t, 3> triangle = {corners[i - 2], corners[i - 1], corners[i]};
      if ((i - begin) % 2 != 0) std::swap(triangle[0], triangle[1]);
      const auto& [a, b, c] = triangle;
      const bool is_stitch = a == b || b == c || c == a;
      // The indices of triangles that are left out are checked, too.
      add_polygon(content, triangle, vertex_count, fail);
      if (is_stitch && !content.points_only()) content.triangles.pop_back();
    }
    begin = end + 1;
  }
}

// Throws Error unless `count` items of at least `least_bytes` each fit into `bytes_left` and 32-bit
// indices can number them. Call this before memory is allocated for a count that a file claims.
void check_count(const NamedInput& input, std::uint64_t count, std::string_view items,
                 std::uint64_t least_bytes, std::uint64_t bytes_left);

// One reader for each format. The readers are strict: everything that the header promises must be
// there, and nothing may follow it. Only after the data of a PCD file there may be padding.
FileContent read_off(const InputFile& input);  // [C][N]OFF
FileContent read_obj(const InputFile& input);  // v, vn, f; other elements are ignored
FileContent read_stl(const InputFile& input);  // ascii, binary; equal vertices merged
// glTF 2.0 binary: the triangles and points of its scene, with the transforms of the nodes applied.
FileContent read_glb(const InputFile& input);
// What is built of a 3MF package (core and production specification), with all transforms applied.
FileContent read_threemf(const InputFile& input);
FileContent read_dxf(const InputFile& input);  // ascii; the 3DFACEs

// Those of the formats of great clouds read a file from front to back and give its points in pieces
// where `content` asks for these. Only PCD's compressed data is held whole.
void read_ply(const InputStream& input, FileContent& content);  // ascii, binary of both endians
void read_pcd(const InputStream& input, FileContent& content);  // ascii, binary, binary_compressed
// Columns: x y z, then any others (intensity, colour, normal in any order), as many in every row.
// The first three columns after x y z that hold a unit vector in every row are the normal. Columns
// are separated by blanks, commas or semicolons, the same throughout the file. Decimal commas are
// refused.
void read_xyz(const InputStream& input, FileContent& content);
// As read_xyz, but the four columns after x y z (intensity and colour) are never part of a normal,
// and the first line may hold the count.
void read_pts(const InputStream& input, FileContent& content);
// Several scans, each with a grid of cells and a pose. Empty cells (0 0 0) are left out.
void read_ptx(const InputStream& input, FileContent& content);
// How many faces, vertices or triangles the header of a file promises whose content may be taken in
// parts. Nothing for other files: PLY as text, with strips of triangles, with lists in front of the
// faces or faces in front of the vertices; STL as text. Throws Error where the header is wrong.
struct PlyCounts {
  std::uint64_t faces = 0, vertices = 0;
};
std::optional<PlyCounts> ply_counts_in_parts(const InputStream& input);
std::optional<std::uint64_t> stl_triangles_in_parts(const InputStream& input);
void read_stl_in_parts(const InputStream& input, FileContent& content);

// A reader of whole files as one of those above.
template <auto kRead>
void read_whole(const InputStream& input, FileContent& content) {
  content.take(kRead(read_input(input)));
}

// LAS 1.0 to 1.4 and LAZ, every point format. The classes of `options` are left out.
void read_las(const InputStream& input, const CloudReadOptions& options, FileContent& content);
// Several scans, each with a pose. Points that are marked as invalid are left out.
void read_e57(const InputStream& input, FileContent& content);

}  // namespace emax
