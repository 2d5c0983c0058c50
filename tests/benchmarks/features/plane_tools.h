#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/features/shapes.h"

namespace emax::benchmarks {

// A plane as a tool finds it.
struct FoundPlane {
  Plane plane;
  std::vector<std::uint32_t> points;
};

struct PlaneTask {
  std::span<const Point> cloud;
  double band;                // farthest of a plane's points from it
  std::size_t least_support;  // points
  std::uint64_t seed = 1;
};

// Each finds the planes of a cloud on one thread, with all that it needs for it but reading the
// file: normals, trees, the plane of least squares of each region.
std::vector<FoundPlane> planes_of_emax(const PlaneTask& task, bool hough);
std::vector<FoundPlane> planes_of_cgal_ransac(const PlaneTask& task);
std::vector<FoundPlane> planes_of_cgal_growing(const PlaneTask& task);
std::vector<FoundPlane> planes_of_pcl_ransac(const PlaneTask& task);

}  // namespace emax::benchmarks
