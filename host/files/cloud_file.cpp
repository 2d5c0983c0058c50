#include "host/files/cloud_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "host/files/file_content.h"
#include "host/files/scan_folder.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Reader = FileContent (*)(const InputFile&);
using StreamReader = FileContent (*)(const InputStream&, const CloudReadOptions&);

constexpr std::array<std::string_view, 14> kEndings{".ply", ".pcd", ".xyz", ".asc", ".txt",
                                                    ".pts", ".obj", ".off", ".las", ".laz",
                                                    ".e57", ".ptx", ".glb", ".3mf"};
// Those of the other endings.
constexpr std::array<std::pair<std::string_view, StreamReader>, 3> kStreamReaders{
    {{".las", read_las}, {".laz", read_las}, {".e57", read_e57}}};
constexpr std::array<std::pair<std::string_view, Reader>, 11> kCloudReaders{{{".ply", read_ply},
                                                                             {".pcd", read_pcd},
                                                                             {".xyz", read_xyz},
                                                                             {".asc", read_xyz},
                                                                             {".txt", read_xyz},
                                                                             {".pts", read_pts},
                                                                             {".obj", read_obj},
                                                                             {".off", read_off},
                                                                             {".glb", read_glb},
                                                                             {".3mf", read_threemf},
                                                                             {".ptx", read_ptx}}};

constexpr auto kEndingOf = [](const auto& reader) { return reader.first; };

FileContent read_content(const std::filesystem::path& path, const CloudReadOptions& options) {
  const std::string ending = format_ending(path);
  const auto of_stream = std::ranges::find(kStreamReaders, ending, kEndingOf);
  if (of_stream != kStreamReaders.end()) {
    const InputStream input(path);
    if (input.size() == 0) input.fail("the file is empty", "export it again");
    check_ending_fits(input, input.head(), ending);
    return of_stream->second(input, options);
  }
  const InputFile input = read_input(path);
  const auto known = std::ranges::find(kCloudReaders, ending, kEndingOf);
  if (known == kCloudReaders.end()) {
    input.fail(fmt::format("unknown ending \"{}\"", printable(ending)),
               fmt::format("clouds are read from {}", fmt::join(kEndings, ", ")));
  }
  check_ending_fits(input, input.bytes, ending);
  return known->second(input);
}

void drop_invalid(PointCloud& cloud) {
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
  cloud.left_out.push_back({"not finite", cloud.points.size() - kept});
  cloud.file_index = std::move(file_index);
  cloud.points.resize(kept);
  if (has_normals) cloud.normals.resize(kept);
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
  FileContent content = read_content(path, options);
  if (!options.left_out_classes.empty() && !content.has_classes) {
    input.fail("--class: only LAS and LAZ files have classes", "leave the option out");
  }
  if (content.vertices.empty()) {
    if (content.left_out.empty()) input.fail("holds no points", "export it again");
    input.fail(fmt::format("every point is left out: {}", describe(content.left_out)),
               "check the options and the export");
  }

  PointCloud cloud{
      std::move(content.vertices), std::move(content.normals),  std::move(content.file_index),
      std::move(content.scans),    std::move(content.left_out), content.unit,
      content.resolution};
  if (!content.first_invalid.empty()) {
    if (!options.skip_invalid) {
      input.fail(fmt::format("{}: a coordinate is NaN or infinite", content.first_invalid),
                 "mend the file, or leave such points out with --skip-invalid");
    }
    drop_invalid(cloud);
    if (cloud.points.empty()) {
      input.fail("every point has a NaN or infinite coordinate", "export it again");
    }
  }
  const auto is_usable = [](const Point& n) { return n.allFinite() && !n.isZero(0); };
  if (!std::ranges::all_of(cloud.normals, is_usable)) cloud.normals.clear();
  return cloud;
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
