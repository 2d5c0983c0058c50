// E57 (ASTM E2807): scans with poses. The crate e57 reads the pages, their checksums and the XML.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/files/file_content.h"
#include "host/files/pose.h"
#include "host/scan_crates/scan_crates.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

Point from_spherical(const Point& p) {
  const double range = p[0], azimuth = p[1], elevation = p[2];
  const double flat = range * std::cos(elevation);
  return {flat * std::cos(azimuth), flat * std::sin(azimuth), range * std::sin(elevation)};
}

// How far the way in which a scan is stored may have moved a point. `greatest` has the greatest
// absolute value of each coordinate.
double resolution_of(const E57Scan& scan, const Point& greatest) {
  constexpr double kHalfStepOfSingle = 0x1p-24;
  Point moved;
  for (int k = 0; k < 3; ++k) {
    const E57Coordinate& c = scan.coordinates[static_cast<std::size_t>(k)];
    moved[k] = c.scale / 2 + (c.single ? kHalfStepOfSingle * greatest[k] : 0);
  }
  if (scan.spherical) {
    moved[1] *= greatest[0];
    moved[2] *= greatest[0];
  }
  return moved.norm();
}

Pose pose_of(const InputStream& input, const E57Scan& scan, std::string_view name) {
  Pose pose;
  if (!scan.has_pose) return pose;
  double squared = 0;
  for (const double q : scan.rotation) squared += q * q;
  const double length = std::sqrt(squared);
  std::array<double, 4> unit = scan.rotation;
  for (double& q : unit) q /= length;
  pose.rotation = rotation_of(unit);
  pose.shift = {scan.translation[0], scan.translation[1], scan.translation[2]};
  if (!(std::abs(squared - 1) <= kGreatestDefect) || !(pose.defect() <= kGreatestDefect)) {
    input.fail(fmt::format("the pose of {} is not a rotation and a shift", name),
               "export the scans with rigid poses");
  }
  return pose;
}

void read_scan(const InputStream& input, E57File& file, std::size_t index, FileContent& content) {
  const E57Scan scan = file.scan(index);
  const std::string name =
      scan.name.empty() ? fmt::format("scan {}", index) : fmt::format("scan \"{}\"", scan.name);
  const Pose pose = pose_of(input, scan, name);
  // At least a bit of each point is in the file.
  check_count(input, scan.records, "points", 1, 8 * input.size());
  check_count(input, content.index_of_next() + scan.records, "points", 1, ~std::uint64_t{0});
  content.scans.push_back({scan.name.empty() ? name : scan.name, content.points()});
  Point greatest = Point::Zero();
  file.read_points(index, [&](std::span<const double> points,
                              std::span<const std::uint8_t> states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (states[i] != E57File::kValid && !EMAX_FAULT(kKeepsInvalid)) {
        content.leave_out(states[i] == E57File::kInvalid ? "marked as invalid" : "only directions");
        continue;
      }
      const Point stored(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
      if (stored.allFinite()) greatest = greatest.cwiseMax(stored.cwiseAbs());
      const Point local = scan.spherical ? from_spherical(stored) : stored;
      content.add_vertex(scan.has_pose ? pose(local) : local, "point", content.index_of_next());
    }
  });
  content.resolution = std::max(content.resolution, resolution_of(scan, greatest));
}

}  // namespace

void read_e57(const InputStream& input, FileContent& content) {
  content.unit = unit_named("m");
  std::string place;
  try {
    E57File file(input.descriptor());
    for (std::size_t i = 0; i < file.scans(); ++i) {
      place = fmt::format("scan {}: ", i);
      read_scan(input, file, i, content);
    }
  } catch (const CrateRefusal& refusal) {
    input.fail(place + refusal.what(), kExportAgain);
  }
}

}  // namespace emax
