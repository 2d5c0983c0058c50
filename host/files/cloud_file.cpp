#include "host/files/cloud_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "host/files/file_content.h"
#include "host/files/las_stream.h"
#include "host/files/scan_folder.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Reader = void (*)(const InputStream&, FileContent&);

constexpr std::string_view kNotFinite = "not finite";
constexpr std::array<std::string_view, 14> kEndings{".ply", ".pcd", ".xyz", ".asc", ".txt",
                                                    ".pts", ".obj", ".off", ".las", ".laz",
                                                    ".e57", ".ptx", ".glb", ".3mf"};
// Those of all endings but .las and .laz, whose points have classes.
constexpr std::array<std::pair<std::string_view, Reader>, 12> kCloudReaders{
    {{".ply", read_ply},
     {".pcd", read_pcd},
     {".xyz", read_xyz},
     {".asc", read_xyz},
     {".txt", read_xyz},
     {".pts", read_pts},
     {".obj", read_whole<read_obj>},
     {".off", read_whole<read_off>},
     {".glb", read_whole<read_glb>},
     {".3mf", read_whole<read_threemf>},
     {".ptx", read_ptx},
     {".e57", read_e57}}};

void read_content(const std::filesystem::path& path, const CloudReadOptions& options,
                  FileContent& content) {
  const std::string ending = format_ending(path);
  const InputStream input(path);
  input.require_content();
  if (std::ranges::find(kEndings, ending) == kEndings.end()) {
    input.fail(fmt::format("unknown ending \"{}\"", printable(ending)),
               fmt::format("clouds are read from {}", fmt::join(kEndings, ", ")));
  }
  check_ending_fits(input, input.head(), ending);
  const auto ending_of = [](const auto& reader) { return reader.first; };
  const auto known = std::ranges::find(kCloudReaders, ending, ending_of);
  if (known == kCloudReaders.end()) {
    read_las(input, options, content);
  } else {
    known->second(input, content);
  }
}

// Throws Error for a file without a point that is kept, and for options that do not fit it.
void check_content(const NamedInput& input, const CloudReadOptions& options,
                   const FileContent& content) {
  if (!options.left_out_classes.empty() && !content.has_classes) {
    input.fail("--class: only LAS and LAZ files have classes", "leave the option out");
  }
  if (content.points() > 0) return;
  if (content.left_out.empty()) input.fail("holds no points", "export it again");
  input.fail(fmt::format("every point is left out: {}", describe(content.left_out)),
             "check the options and the export");
}

void drop_points_that_are_not_finite(PointCloud& cloud) {
  std::size_t kept = 0;
  std::vector<std::uint32_t> file_index;
  auto scan = cloud.scans.begin();
  const bool has_normals = !cloud.normals.empty();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    for (; scan != cloud.scans.end() && scan->begin == i; ++scan) scan->begin = kept;
    if (!cloud.points[i].allFinite()) continue;
    file_index.push_back(cloud.index_in_file(i));
    cloud.points[kept] = cloud.points[i];
    if (has_normals) cloud.normals[kept] = cloud.normals[i];
    ++kept;
  }
  for (; scan != cloud.scans.end(); ++scan) scan->begin = kept;
  cloud.left_out.push_back({std::string(kNotFinite), cloud.points.size() - kept});
  cloud.file_index = std::move(file_index);
  cloud.points.resize(kept);
  if (has_normals) cloud.normals.resize(kept);
}

// Drops the points with a NaN or infinite coordinate if that is asked for, else throws Error.
void drop_invalid(const NamedInput& input, const CloudReadOptions& options,
                  const std::string& first_invalid, PointCloud& cloud) {
  if (first_invalid.empty()) return;
  if (!options.skip_invalid) {
    input.fail(fmt::format("{}: a coordinate is NaN or infinite", first_invalid),
               "mend the file, or leave such points out with --skip-invalid");
  }
  drop_points_that_are_not_finite(cloud);
}

void require_points(const NamedInput& input, std::uint64_t points) {
  if (points == 0) input.fail("every point has a NaN or infinite coordinate", "export it again");
}

// The first of the points with the greatest `measure`, and that measure.
template <class Measure>
std::pair<Point, double> farthest(const std::vector<Point>& points, const Measure& measure) {
  std::pair<Point, double> best{points.front(), measure(points.front())};
  for (const Point& point : points) {
    if (const double m = measure(point); m > best.second) best = {point, m};
  }
  return best;
}

// As read_cloud_in_pieces(), of what `read` adds to a content.
PointCloud pieces_of(const NamedInput& input, const CloudReadOptions& options,
                     std::size_t piece_points, const std::function<void(PointCloud)>& take,
                     const PieceChoice& choice, const std::function<void(FileContent&)>& read) {
  FileContent content;
  std::uint64_t points = 0, not_finite = 0;
  const auto give = [&](FileContent& c) {
    PointCloud piece;
    piece.first_index = static_cast<std::uint32_t>(c.points_given - c.vertices.size());
    piece.points = std::move(c.vertices);
    piece.file_index = std::move(c.file_index);
    drop_invalid(input, options, c.first_invalid, piece);
    for (const LeftOut& part : piece.left_out) not_finite += part.points;
    if (!c.wants_piece()) {
      piece.unwanted = piece.points.size() + c.points_passed;
      piece.points.clear();
    }
    points += piece.points.size() + piece.unwanted;
    if (!piece.points.empty() || piece.unwanted > 0) take(std::move(piece));
  };
  content.take_pieces(piece_points, give, choice);
  read(content);
  content.give_piece();
  check_content(input, options, content);
  require_points(input, points);
  if (not_finite > 0) content.left_out.push_back({std::string(kNotFinite), not_finite});
  PointCloud rest;
  rest.left_out = std::move(content.left_out);
  rest.unit = content.unit;
  rest.resolution = content.resolution;
  return rest;
}

}  // namespace

std::span<const std::string_view> cloud_endings() { return kEndings; }

std::string describe(const std::vector<LeftOut>& left_out) {
  std::string text;
  for (const LeftOut& part : left_out) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", part.points, part.reason);
  }
  return text;
}

PointCloud read_cloud(const std::filesystem::path& path, const CloudReadOptions& options) {
  if (std::filesystem::is_directory(path)) return read_scan_folder(path, options);
  const NamedInput input{path.string()};
  FileContent content;
  read_content(path, options, content);
  check_content(input, options, content);

  PointCloud cloud{
      std::move(content.vertices), std::move(content.normals),  std::move(content.file_index),
      std::move(content.scans),    std::move(content.left_out), content.unit,
      content.resolution};
  drop_invalid(input, options, content.first_invalid, cloud);
  require_points(input, cloud.points.size());
  const auto is_usable = [](const Point& n) { return n.allFinite() && !n.isZero(0); };
  if (!std::ranges::all_of(cloud.normals, is_usable)) cloud.normals.clear();
  return cloud;
}

PointCloud read_cloud_in_pieces(const std::filesystem::path& path, const CloudReadOptions& options,
                                std::size_t piece_points,
                                const std::function<void(PointCloud)>& take,
                                const PieceChoice& choice) {
  if (std::filesystem::is_directory(path)) {
    return read_scan_folder_in_pieces(path, options, piece_points, take, choice);
  }
  return pieces_of(NamedInput{path.string()}, options, piece_points, take, choice,
                   [&](FileContent& content) { read_content(path, options, content); });
}

PointCloud read_cloud_in_pieces(LasStream& stream, const CloudReadOptions& options,
                                std::size_t piece_points,
                                const std::function<void(PointCloud)>& take,
                                const PieceChoice& choice) {
  return pieces_of(stream.input(), options, piece_points, take, choice,
                   [&](FileContent& content) { stream.read(options, content); });
}

void check_cloud(const PointCloud& cloud, std::string_view file) {
  const auto fail = [&](std::string_view what, std::string_view remedy) {
    throw Error(fmt::format("{}: {}; {}", file, what, remedy));
  };
  const std::vector<Point>& points = cloud.points;
  if (points.size() < 4) {
    fail(fmt::format("{} points are too few for a surface", points.size()),
         "give a cloud of at least 4 points");
  }
  const Point origin = points.front();
  const auto [far_end, extent] =
      farthest(points, [&](const Point& p) { return (p - origin).stableNorm(); });
  if (extent == 0) fail("all points are equal", "check that the columns of the export vary");

  double greatest = 0;
  for (const Point& p : points) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  const double tolerance =
      std::max(1e-9 * extent, 8 * std::numeric_limits<double>::epsilon() * greatest);
  const Point direction = (far_end - origin) / extent;
  const double from_line = farthest(points, [&](const Point& p) {
                             return direction.cross(p - origin).stableNorm();
                           }).second;
  if (from_line <= tolerance) {
    fail("all points lie on one line", "check that the columns of the export vary independently");
  }
}

}  // namespace emax
