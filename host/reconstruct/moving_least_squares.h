#pragma once

#include <span>
#include <vector>

#include "host/parameters/registry.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// The cloud on its moving least squares surface, by PCL: every point projected onto a polynomial
// that is fitted to its neighbours within Mls::kRadius, of degree Mls::kOrder. A point of fewer
// than three neighbours stays as it is. Mls::Method::kResample: first one point of every cell of
// Mls::kCell, the one of least index, so that no region is denser than that; neighbours are those
// of the whole cloud. Lengths are in multiples of the median point spacing. O(n k) for k
// neighbours.
std::vector<Point> on_least_squares_surface(std::span<const Point> points,
                                            const ParameterValues& values);

// A moving least squares surface in the neighbourhood of a hole (paper, section 2.2 and [4], [5]):
// for every point asked a polynomial of degree two over the plane that fits the points best, their
// weights falling with the distance as exp(-(d / radius)^2); with fewer than six points the plane.
class LeastSquaresPatch {
 public:
  // At least three points.
  LeastSquaresPatch(std::span<const Point> points, double radius);

  // Along the normal of the plane; the point itself where nothing can be fitted. O(points).
  Point project(const Point& point) const;

 private:
  std::vector<Point> points_;
  Point origin_;
  double scale_;  // of the coordinates that the fit is made in
  double radius_;
};

}  // namespace emax
