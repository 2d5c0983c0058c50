#include "host/app/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iterator>

#include "host/files/atomic_file.h"
#include "host/files/cloud_file.h"
#include "host/files/input_file.h"
#include "host/files/mesh_file.h"
#include "host/files/spooled_input.h"
#include "host/geometry/bounds.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/merge_vertices.h"
#include "host/report/certificate_file.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {

Scan read_scan(const std::filesystem::path& path, const CloudReadOptions& reading,
               std::string_view unit) {
  Scan scan = {path, read_cloud(path, reading), 0, unit_named(unit)};
  if (unit.empty()) scan.unit = scan.cloud.unit;
  check_cloud(scan.cloud, path.string());
  scan.width = bounds_of(scan.cloud.points).width();
  return scan;
}

void require_unit_of(const Scan& scan, const std::filesystem::path& file,
                     const std::optional<Unit>& unit) {
  if (!unit || !scan.unit || unit == scan.unit) return;
  throw Error(fmt::format("{}: is in {}, but {} is in {}; convert one of them{}", file.string(),
                          unit->name, scan.path.string(), scan.unit->name,
                          scan.cloud.unit ? "" : ", or leave --unit out to compare the numbers"));
}

std::string describe(const Scan& scan) { return describe(scan, scan.cloud.points.size()); }

std::string describe(const Scan& scan, std::uint64_t points) {
  std::string text = fmt::format("{}: {} points, width {}", scan.path.string(), grouped(points),
                                 length_text(scan.width, scan.unit));
  const std::optional<Unit>& stated = scan.cloud.unit;
  if (stated && scan.unit != stated) text += fmt::format(" (the file says {})", stated->name);
  return text;
}

Scan vertices_of(const std::filesystem::path& path, const TriangleMesh& mesh) {
  std::vector<Triangle> surface;
  std::ranges::copy_if(mesh.triangles, std::back_inserter(surface), [&](const Triangle& t) {
    return !collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  });
  if (surface.empty()) {
    throw Error(
        fmt::format("{}: no triangle of any area; give a mesh that is a surface", path.string()));
  }
  const std::vector<bool> used = used_vertices(mesh.vertices.size(), surface);
  Scan scan = {path, {}, 0};
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    scan.cloud.points.push_back(mesh.vertices[v]);
    scan.cloud.file_index.push_back(v);
  }
  scan.width = bounds_of(scan.cloud.points).width();
  return scan;
}

bool is_surface(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return false;
  const std::string ending = format_ending(path);
  const auto among = [&](std::span<const std::string_view> endings) {
    return std::ranges::find(endings, ending) != endings.end();
  };
  return among(mesh_endings()) && (!among(cloud_endings()) || holds_triangles(path));
}

EmaxResult kernel_error(const Scan& scan, MeshView mesh, std::span<const std::uint32_t> excluded) {
  const PreparedCloud cloud(scan.cloud.points);
  ErrorEngine engine(cloud, {.threads = processor_threads(), .interrupted = nullptr});
  const PreparedMesh prepared(mesh, cloud.normalization(), engine.target(), processor_threads());
  std::vector<std::uint32_t> bits = engine.squared_distances(prepared);
  for (const std::uint32_t i : excluded) bits[i] = 0;
  EmaxResult worst = worst_of(bits);
  worst.worst_point = scan.cloud.index_in_file(worst.worst_point);
  return worst;
}

void require_resolution(const Scan& scan, double epsilon) {
  const double moved = scan.cloud.resolution;
  if (moved <= kResolutionShare * epsilon) return;
  throw Error(fmt::format(
      "{}: the resolution of its coordinates may move points by {:.3g}, more than a hundredth of "
      "the tolerance {:.6g}; export it with finer steps, or give a tolerance of at least {:.3g}",
      scan.path.string(), moved, epsilon, 1.01 * moved / kResolutionShare));
}

std::optional<Tolerance> given_tolerance(const std::string& max_error, int level) {
  if (max_error.empty()) return level > 0 ? std::optional(tolerance_of_level(level)) : std::nullopt;
  if (level > 0) throw Error("--loa is a tolerance, too: leave it out or --max-error");
  return parse_tolerance(max_error);
}

std::string level_text(int level) {
  return level > 0 ? fmt::format(" (represented accuracy, LOA {}, as a maximum)", level) : "";
}

double tolerance_below_width(const Tolerance& tolerance, std::string_view option,
                             const Scan& scan) {
  const double length = below_width(tolerance, option, scan);
  require_resolution(scan, length);
  return length;
}

double below_width(const Tolerance& given, std::string_view option, const Scan& scan) {
  const double length = given.in_unit_of(scan.unit, option).in_units(scan.width);
  if (length < scan.width) return length;
  throw Error(
      fmt::format("{} {:.6g} is no less than the width of {}, {:.6g}: give it in the unit of the "
                  "file, or as N%",
                  option, length, scan.path.string(), scan.width));
}

void check_not_among_scans(const std::filesystem::path& output,
                           const std::filesystem::path& cloud) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(cloud)) return;
  const fs::path folder = fs::absolute(output).parent_path();
  if (!fs::is_directory(folder) || !fs::equivalent(folder, cloud)) return;
  throw Error(fmt::format("{}: lies among the scans of {}; name an output outside of it",
                          output.string(), cloud.string()));
}

void check_mesh_outputs(const std::filesystem::path& mesh, bool with_reference) {
  if (mesh == kStandardInput) {
    throw Error("-o -: the certificate lies beside the mesh, so the mesh needs a file; name one");
  }
  check_output(mesh, mesh_endings());
  check_output(certificate_path(mesh), kJsonEndings);
  if (with_reference) check_output(reference_path(mesh), mesh_endings());
}

double parse_share(std::string_view text) {
  const bool percent = text.ends_with('%');
  const std::string_view digits = text.substr(0, text.size() - (percent ? 1 : 0));
  double value = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (percent) value /= 100;
  if (failure != std::errc{} || end != digits.data() + digits.size() ||
      !(value >= 0 && value < 1)) {
    throw Error(fmt::format(
        "--exclude-outliers '{}': give a share of the points from 0 to below 1, or N%", text));
  }
  return value;
}

CertifiedError in_file_indices(CertifiedError error, const PointCloud& cloud) {
  error.worst_point = cloud.index_in_file(error.worst_point);
  for (std::uint32_t& point : error.excluded) point = cloud.index_in_file(point);
  return error;
}

EmaxResult in_file_indices(EmaxResult result, const PointCloud& cloud) {
  result.worst_point = cloud.index_in_file(result.worst_point);
  return result;
}

std::vector<std::uint32_t> in_cloud(std::span<const std::uint32_t> in_file,
                                    const PointCloud& cloud) {
  std::vector<std::uint32_t> indices(in_file.begin(), in_file.end());
  for (std::uint32_t& index : indices) {
    if (cloud.file_index.empty()) continue;
    const auto at = std::ranges::lower_bound(cloud.file_index, index);
    const bool found = at != cloud.file_index.end() && *at == index;
    index = found ? static_cast<std::uint32_t>(at - cloud.file_index.begin()) : ~0u;
  }
  return indices;
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, 1, ',');
  return text;
}

std::string describe(const MeshValidity& v) {
  if (v.valid()) return "valid: manifold, consistently oriented, free of self-intersections";
  std::string text = "not valid:";
  const auto count = [&text](std::size_t number, const char* what) {
    if (number > 0) text += fmt::format(" {} {},", grouped(number), what);
  };
  count(v.non_manifold_edges, "non-manifold edges");
  count(v.non_manifold_vertices, "non-manifold vertices");
  count(v.inconsistent_edges, "inconsistently oriented edges");
  count(v.degenerate_triangles, "degenerate triangles");
  count(v.self_intersections, "self-intersections");
  text.pop_back();
  return text;
}

void print_left_out(Facts& facts, const PointCloud& cloud) {
  if (cloud.left_out.empty()) return;
  facts.add("left out", "{}", describe(cloud.left_out));
}

void print_doubtful_unit(Facts& facts, double width, const std::optional<Unit>& unit) {
  constexpr double kWidest = 5e3, kSmallest = 1e-4;  // metres
  if (!unit) return;
  const double metres = width * unit->metres;
  if (metres >= kSmallest && metres <= kWidest) return;
  facts.add("remark",
            "a width of {} is hardly that of a scan; if the numbers are not {}, say --unit {}",
            length_text(width, unit), unit->name, metres > kWidest ? "mm" : "m");
}

void print_excluded(Facts& facts, const CertifiedError& certified, std::size_t excludable) {
  if (excludable == 0) return;
  facts.add("outliers", "{} of at most {} points excluded; e_max over all points {:.9g}",
            grouped(certified.excluded.size()), grouped(excludable), certified.e_max_upper_all);
}

}  // namespace emax
