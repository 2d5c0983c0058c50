#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/app/facts.h"
#include "host/app/report_options.h"
#include "host/device/device_address.h"
#include "host/engine/error_engine.h"
#include "host/files/cloud_file.h"
#include "host/files/tolerance.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/point_cloud.h"
#include "host/geometry/triangle_mesh.h"
#include "sw_model/certify/certificate.h"

namespace emax {

inline constexpr std::array<std::string_view, 1> kJsonEndings = {".json"};

// Options that optimize and error share.
struct CommonOptions {
  std::string cloud;
  std::string device = "cpu";
  std::string json;
  ReportOptions report;
  std::string excluded_share = "0";
  CloudReadOptions reading;
  std::string unit;  // of the cloud's numbers; empty: what the file says
  bool brute_force = false;
};

// A cloud that was read and passed check_cloud().
struct Scan {
  std::filesystem::path path;
  PointCloud cloud;
  double width;
  std::optional<Unit> unit = {};  // of the coordinates, where it is known
};

// The vertices of the triangles of a mesh that have an area, as a scan. A mesh may be flat, or have
// fewer points than a cloud needs. Other vertices are not part of its surface. Throws Error if no
// triangle has an area.
Scan vertices_of(const std::filesystem::path& path, const TriangleMesh& mesh);

// `unit`: that of the file's numbers, as given to --unit; empty: what the file says.
Scan read_scan(const std::filesystem::path& path, const CloudReadOptions& reading,
               std::string_view unit = {});

// Throws Error if a file states a unit for its mesh, and the scan's numbers are known to be in
// another.
void require_unit_of(const Scan& scan, const std::filesystem::path& file,
                     const std::optional<Unit>& unit);

// What a command prints of its scan: "scan.ply: 1,234 points, width 5 m", and which unit was taken
// in place of the file's.
std::string describe(const Scan& scan);
// The same of a scan whose points are not in memory.
std::string describe(const Scan& scan, std::uint64_t points);

// Whether the file is one of a mesh: one whose ending is used for clouds, too, counts as that if it
// has triangles. Throws Error for a damaged file.
bool is_surface(const std::filesystem::path& path);

// The kernel's error over the points that are not excluded; the index of its worst point is the
// file's.
EmaxResult kernel_error(const Scan& scan, MeshView mesh, std::span<const std::uint32_t> excluded);

// The share of a tolerance by which the numbers in a scan's file may have moved points.
inline constexpr double kResolutionShare = 0.01;
// Throws Error if the numbers in the scan's file are coarser than that share of `epsilon`.
void require_resolution(const Scan& scan, double epsilon);

// The tolerance of --max-error or, where that is empty, of --loa (0: none given). Throws Error
// where both are given.
std::optional<Tolerance> given_tolerance(const std::string& max_error, int level);

// " (represented accuracy, LOA 30, as a maximum)"; empty for level 0.
std::string level_text(int level);

// The tolerance in the scan's unit. Throws Error naming the option if the tolerance is not less
// than the scan's width, as when it is given in another unit, and as require_resolution().
double below_width(const Tolerance& length, std::string_view option, const Scan& scan);
// Also not below what the resolution of the scan's coordinates allows.
double tolerance_below_width(const Tolerance& tolerance, std::string_view option, const Scan& scan);

// Calls check_output for the mesh, the certificate and, if there may be one, the reference.
void check_mesh_outputs(const std::filesystem::path& mesh, bool with_reference);

// Throws Error if `output` would lie in the folder of scans that is read, and become one of them.
void check_not_among_scans(const std::filesystem::path& output, const std::filesystem::path& cloud);

// "N" or "N%" of the points, 0 <= N < 1 (100%). Throws Error.
double parse_share(std::string_view text);

// Replaces the cloud's indices by the file's, which differ if points were skipped.
CertifiedError in_file_indices(CertifiedError error, const PointCloud& cloud);
EmaxResult in_file_indices(EmaxResult result, const PointCloud& cloud);

// Converts numbers of points in the file to indices of the cloud, ~0 for a point that it lacks.
std::vector<std::uint32_t> in_cloud(std::span<const std::uint32_t> in_file,
                                    const PointCloud& cloud);

// 1234567 as "1,234,567".
std::string grouped(std::uint64_t number);

// Prints how many points of the file were left out and why, if any were.
void print_left_out(Facts& facts, const PointCloud& cloud);
// Prints a remark where no scan is so wide or so small in the unit, as in files of millimetres that
// say metres.
void print_doubtful_unit(Facts& facts, double width, const std::optional<Unit>& unit);

// "valid: ..." or "not valid: 3 non-manifold edges, ..."
std::string describe(const MeshValidity& validity);

// Prints how many points were excluded, if that is permitted, and e_max over all points.
void print_excluded(Facts& facts, const CertifiedError& certified, std::size_t excludable);

}  // namespace emax
