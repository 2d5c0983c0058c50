#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/report/deviations.h"

namespace emax {

// Of more points a report shows only so many.
inline constexpr std::size_t kMostPointsShown = 2'000'000;

// Points and mesh as a report shows them: rounded to what a screen can show, in few bytes. The
// exact numbers of a report stand in its JSON.
struct ReportGeometry {
  std::size_t points = 0, points_of = 0;  // shown, and all that are not excluded
  std::size_t vertices = 0, triangles = 0;
  Point origin = Point::Zero(), step = Point::Zero();  // coordinate = origin + step * number
  double deviation_step = 0;
  Point up = Point::UnitZ();
  // Little endian, one array after the other (report_json.cpp has the names): x, y, z of the
  // points as uint16; their deviations as int16, of which +-32767 stands for that and more; x, y, z
  // of the vertices as binary32 from the origin; the triangles as uint32; their deviations as
  // binary32, NaN where there is none.
  std::string bytes;
};

// The points that are shown, as indices of the cloud along its Morton curve: every one that is not
// excluded, or kMostPointsShown of them, `always` among these and the others evenly spread over
// the curve. O(n log n).
std::vector<std::uint32_t> points_shown(std::span<const Point> cloud,
                                        std::span<const std::uint32_t> excluded,
                                        std::span<const std::uint32_t> always,
                                        std::size_t most = kMostPointsShown);

// `shown`: indices of the cloud; `reach`: the deviation at the ends of the legend, above 0.
// Vertices are stored in the order in which triangles use them, so that they compress; those of no
// triangle are left out. O(n).
ReportGeometry report_geometry(std::span<const Point> cloud, std::span<const std::uint32_t> shown,
                               MeshView mesh, const Deviations& deviations, double reach);

}  // namespace emax
