#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace emax {

// The outline of points in a plane.
struct Outline {
  std::vector<Eigen::Vector2d> polygon;  // closed, its last corner is not its first; anticlockwise
  double area = 0;                       // inside it, of openings too
};

// The points are counted in square cells of twice the side that each would have if they were spread
// evenly, gaps of a cell are closed, and the outer border of the greatest connected set of cells is
// followed by the middles of its cells (Sonka, Hlavac and Boyle, "Image processing, analysis and
// machine vision", inner boundary tracing) and simplified to within three quarters of one. True to
// about a cell. Empty for fewer than three points and for points on a line. O(n).
Outline outline_of(std::span<const Eigen::Vector2d> points);

}  // namespace emax
