#include "host/report/deviations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/geometry/bounds.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/mesh_sides.h"
#include "sw_model/base/morton.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {
namespace {

constexpr std::size_t kPoints = 4096;  // points

bool is_consistently_oriented(MeshView mesh) {
  bool consistent = true;
  EdgeSides(mesh).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() > 2) consistent = false;
    if (sides.size() == 2 && sides[0].ascends == sides[1].ascends) consistent = false;
  });
  return consistent;
}

}  // namespace

std::vector<std::uint32_t> along_morton_curve(std::span<const Point> points) {
  if (points.empty()) return {};
  constexpr double kLastCell = 65535;
  const Bounds box = bounds_of(points);
  const double width = box.width();
  const double scale = width > 0 ? kLastCell / width : 0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint64_t code = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double cell = std::clamp((points[i][k] - box.lower[k]) * scale, 0.0, kLastCell);
      code = code << 1 | spread_bits(static_cast<std::uint64_t>(cell));
    }
    keys.emplace_back(code, i);
  }
  std::ranges::sort(keys);
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [code, i] : keys) order.push_back(i);
  return order;
}

Deviations deviations_of(std::span<const Point> cloud, MeshView mesh,
                         std::span<const std::uint32_t> excluded, std::size_t threads) {
  Deviations deviations;
  deviations.are_signed = is_consistently_oriented(mesh);
  deviations.of_points.resize(cloud.size());
  deviations.nearest.resize(cloud.size());
  const ExactMesh exact(mesh);
  const MeshSides sides(mesh);
  const std::vector<std::uint32_t> order = along_morton_curve(cloud);
  in_pieces(threads, order.size(), kPoints, [&](std::size_t, std::size_t first, std::size_t last) {
    std::uint32_t near = ~0u;
    for (const std::uint32_t i : std::span(order).subspan(first, last - first)) {
      const ExactMesh::Nearest nearest =
          exact.nearest(cloud[i], -std::numeric_limits<double>::infinity(), near);
      near = nearest.triangle;
      deviations.nearest[i] = near;
      const double side = deviations.are_signed ? sides.side_of(cloud[i], near) : 1;
      deviations.of_points[i] = side * nearest.distance.upper;
    }
  });

  std::vector<bool> is_excluded(cloud.size(), false);
  for (const std::uint32_t i : excluded) is_excluded[i] = true;
  deviations.of_triangles.assign(mesh.triangles.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (is_excluded[i]) continue;
    float& greatest = deviations.of_triangles[deviations.nearest[i]];
    const auto deviation = static_cast<float>(deviations.of_points[i]);
    if (std::isnan(greatest) || std::abs(deviation) > std::abs(greatest)) greatest = deviation;
  }
  return deviations;
}

std::vector<float> deviations_of_vertices(MeshView mesh, std::span<const float> of_triangles) {
  std::vector<float> greatest(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (std::abs(of_triangles[t]) > std::abs(greatest[v])) greatest[v] = of_triangles[t];
    }
  }
  return greatest;
}

}  // namespace emax
