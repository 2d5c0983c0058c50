#pragma once

#include <string>
#include <vector>

namespace emax {

// One mesh of a sequence: its bound and how many triangles it has.
struct CurvePoint {
  double epsilon;  // above 0
  std::size_t triangles;
};

// Triangles by the bound on logarithmic axes (the source's Fig. 3), as an SVG picture of 640 x 420.
// `unit` names what epsilon is in, "% of the width" or "the cloud's unit". Points in any order.
std::string curve_svg(std::vector<CurvePoint> points, const std::string& unit);

}  // namespace emax
