#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax::test {

// Scans whose surface is known. Lengths are in multiples of the distance between neighbouring
// points of an even scan.

inline constexpr std::array<std::string_view, 5> kScannedShapes = {"sphere", "torus", "box",
                                                                   "sheet", "slots"};

enum class Density {
  kEven,    // points at least 1 apart
  kGraded,  // 0.5 apart on one side of the shape, 2 on the other
  kLines,   // 0.5 apart along lines that are 2 apart
};

struct ScanSettings {
  std::string_view shape = "sphere";
  Density density = Density::kEven;
  double noise = 0;     // standard deviation of every coordinate
  bool holes = false;   // two round holes of radius 7 in the surface
  double outliers = 0;  // stray points in the box around the shape, as a share of the points
  double scale = 1;     // of the shape, while the distance between points stays
  std::uint64_t seed = 1;
};

struct ScanOfShape {
  std::string name;
  TriangleMesh surface;  // what was scanned: manifold, outward, closed but for borders and holes
  std::vector<Point> points;  // outliers last
  std::size_t outliers = 0;
};

// sphere and torus are smooth; box has sharp edges; sheet is a wavy rectangle; slots is a U-shaped
// body with a slot of width 6 and a plate at a distance of 6, two components.
TriangleMesh shape_surface(std::string_view shape, double scale = 1);

// 6,000 to 10,000 points at scale 1. The same for the same settings.
ScanOfShape scan_of_shape(const ScanSettings& settings);

// Points spread evenly over a mesh, about `per_area` for a unit of area.
std::vector<Point> points_on(const TriangleMesh& mesh, double per_area, std::uint64_t seed);

}  // namespace emax::test
