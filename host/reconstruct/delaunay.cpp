#include "host/reconstruct/delaunay.h"

#include <algorithm>
#include <boost/polygon/voronoi.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace emax {
namespace {

constexpr double kGrid = 1 << 29;

struct GridPoints {
  std::vector<boost::polygon::point_data<std::int32_t>> points;  // distinct
  std::vector<std::uint32_t> number;                             // of each, the first on it
  double step = 0;
};

GridPoints on_grid(std::span<const Eigen::Vector2d> points) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : points) box.extend(p);
  GridPoints grid;
  if (points.empty() || !(box.sizes().maxCoeff() > 0)) return grid;
  grid.step = box.sizes().maxCoeff() / kGrid;
  const auto rounded = [&](std::uint32_t i) {
    const Eigen::Vector2d p = (points[i] - box.min()) / grid.step;
    return boost::polygon::point_data<std::int32_t>(static_cast<std::int32_t>(std::lround(p.x())),
                                                    static_cast<std::int32_t>(std::lround(p.y())));
  };
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
    const auto a = rounded(i), b = rounded(j);
    return a == b ? i < j : a < b;
  });
  for (const std::uint32_t i : order) {
    if (!grid.points.empty() && rounded(i) == grid.points.back()) continue;
    grid.points.push_back(rounded(i));
    grid.number.push_back(i);
  }
  return grid;
}

}  // namespace

std::vector<Triangle> alpha_shape(std::span<const Eigen::Vector2d> points, double reach) {
  const GridPoints grid = on_grid(points);
  std::vector<Triangle> triangles;
  if (grid.points.size() < 3) return triangles;
  boost::polygon::voronoi_diagram<double> diagram;
  boost::polygon::construct_voronoi(grid.points.begin(), grid.points.end(), &diagram);
  for (const auto& vertex : diagram.vertices()) {
    // A vertex of the diagram is the centre of a circle through the points of the cells around it.
    const auto* const first = vertex.incident_edge();
    const auto& on_circle = grid.points[first->cell()->source_index()];
    const double radius = std::hypot(vertex.x() - on_circle.x(), vertex.y() - on_circle.y());
    if (!(radius * grid.step <= reach)) continue;
    const std::uint32_t apex = grid.number[first->cell()->source_index()];
    const auto* edge = first->rot_next();
    for (; edge->rot_next() != first; edge = edge->rot_next()) {
      triangles.push_back({apex, grid.number[edge->cell()->source_index()],
                           grid.number[edge->rot_next()->cell()->source_index()]});
    }
  }
  return triangles;
}

}  // namespace emax
