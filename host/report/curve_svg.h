#pragma once

#include <string>
#include <vector>

namespace emax {

// One mesh of a sequence: its bound and its number of triangles.
struct CurvePoint {
  double epsilon;  // above 0
  std::size_t triangles;
};

// Triangles by the bound on logarithmic axes (the source's Fig. 3), as an SVG picture of 640 x 420.
// `unit` is the unit of epsilon, "% of the width" or "the cloud's unit". Points may come in any
// order.
std::string curve_svg(std::vector<CurvePoint> points, const std::string& unit);

}  // namespace emax
