#include "host/files/cloud_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "host/files/file_content.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Reader = FileContent (*)(const InputFile&);

constexpr std::array<std::string_view, 8> kEndings{".ply", ".pcd", ".xyz", ".asc",
                                                   ".txt", ".pts", ".obj", ".off"};
constexpr std::array<Reader, 8> kReaders{read_ply, read_pcd, read_xyz, read_xyz,
                                         read_xyz, read_pts, read_obj, read_off};

void drop_invalid(PointCloud& cloud) {
  std::size_t kept = 0;
  const bool has_normals = !cloud.normals.empty();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    cloud.file_index.push_back(static_cast<std::uint32_t>(i));
    cloud.points[kept] = cloud.points[i];
    if (has_normals) cloud.normals[kept] = cloud.normals[i];
    ++kept;
  }
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

PointCloud read_cloud(const std::filesystem::path& path, const CloudReadOptions& options) {
  const InputFile input = read_input(path);
  const std::string ending = lower_case_ending(path);
  const auto known = std::ranges::find(kEndings, ending);
  if (known == kEndings.end()) {
    input.fail(fmt::format("unknown ending \"{}\"", printable(ending)),
               fmt::format("clouds are read from {}", fmt::join(kEndings, ", ")));
  }
  check_ending_fits(input, ending);
  FileContent content = kReaders[static_cast<std::size_t>(known - kEndings.begin())](input);
  if (content.vertices.empty()) input.fail("holds no points", "export it again");

  PointCloud cloud{std::move(content.vertices), std::move(content.normals), {}};
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
