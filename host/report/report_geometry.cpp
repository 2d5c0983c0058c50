#include "host/report/report_geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/files/append_value.h"
#include "host/geometry/bounds.h"

namespace emax {
namespace {

constexpr double kLastStep = 65535;
constexpr double kClipped = 32767;
// A screen shows no finer numbers, and finer ones would not compress: of deviations and places, as
// a share of the reach of the legend, and of places also as a share of the width.
constexpr double kDeviationShare = 1.0 / 2000, kPlaceShare = 1.0 / 16;
constexpr double kWidthShare = 1.0 / 16384;
// Vertices are that much finer than the places of points. Their step is a power of two, so that the
// last bits of their coordinates are 0.
constexpr double kVertexShare = 1.0 / 4;

// Of 24 bits the 12 last become 0: the colour of a triangle needs no more.
float coarse(float value) {
  if (!std::isfinite(value)) return value;
  int exponent = 0;
  const float mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 12)), exponent - 12);
}

void append_points(ReportGeometry& geometry, std::span<const Point> cloud,
                   std::span<const std::uint32_t> shown, std::span<const double> deviations) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double step = geometry.step[k];
    for (const std::uint32_t i : shown) {
      const double at = step > 0 ? std::round((cloud[i][k] - geometry.origin[k]) / step) : 0;
      append_value(geometry.bytes, static_cast<std::uint16_t>(std::clamp(at, 0.0, kLastStep)));
    }
  }
  for (const std::uint32_t i : shown) {
    const double at = std::round(deviations[i] / geometry.deviation_step);
    append_value(geometry.bytes, static_cast<std::int16_t>(std::clamp(at, -kClipped, kClipped)));
  }
}

void append_mesh(ReportGeometry& geometry, MeshView mesh, double enough,
                 std::span<const float> deviations) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> place(mesh.vertices.size(), kUnused), order;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (place[v] != kUnused) continue;
      place[v] = static_cast<std::uint32_t>(order.size());
      order.push_back(v);
    }
  }
  geometry.vertices = order.size();
  const double step = enough > 0 ? std::exp2(std::floor(std::log2(kVertexShare * enough))) : 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    for (const std::uint32_t v : order) {
      const double at = mesh.vertices[v][k] - geometry.origin[k];
      append_value(geometry.bytes,
                   static_cast<float>(step > 0 ? std::round(at / step) * step : at));
    }
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) append_value(geometry.bytes, place[v]);
  }
  for (const float d : deviations) append_value(geometry.bytes, coarse(d));
}

}  // namespace

std::vector<std::uint32_t> points_shown(std::span<const Point> cloud,
                                        std::span<const std::uint32_t> excluded,
                                        std::span<const std::uint32_t> always, std::size_t most) {
  std::vector<bool> is_excluded(cloud.size(), false), is_shown(cloud.size(), false);
  for (const std::uint32_t i : excluded) is_excluded[i] = true;
  std::vector<std::uint32_t> order = along_morton_curve(cloud);
  std::erase_if(order, [&](std::uint32_t i) { return is_excluded[i]; });
  if (order.size() <= most) return order;
  for (const std::uint32_t i : always) is_shown[i] = true;
  const std::size_t evenly = most - std::min(most, always.size());
  for (std::size_t k = 0; k < evenly; ++k) is_shown[order[k * order.size() / evenly]] = true;
  std::erase_if(order, [&](std::uint32_t i) { return !is_shown[i]; });
  return order;
}

ReportGeometry report_geometry(std::span<const Point> cloud, std::span<const std::uint32_t> shown,
                               MeshView mesh, const Deviations& deviations, double reach) {
  ReportGeometry geometry;
  geometry.points = shown.size();
  geometry.triangles = mesh.triangles.size();
  geometry.deviation_step = kDeviationShare * reach;
  double enough = 0;  // for a place
  if (!cloud.empty()) {
    const Bounds box = bounds_of(cloud);
    geometry.origin = box.lower;
    enough = std::min(kPlaceShare * reach, kWidthShare * box.width());
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double extent = box.upper[k] - box.lower[k];
      geometry.step[k] = extent > 0 ? std::max(extent / kLastStep, enough) : 0;
    }
  }
  append_points(geometry, cloud, shown, deviations.of_points);
  append_mesh(geometry, mesh, enough, deviations.of_triangles);
  return geometry;
}

}  // namespace emax
