#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/features/shapes.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// Planes that a surface follows in parts, and the points of a scan that show where.
struct PlaneParts {
  std::vector<Plane> planes;
  std::vector<Point> points;
  std::vector<std::uint32_t> plane_of;  // of each point; kNoPlane: of none
  struct Support {
    std::size_t points = 0;
    double rms = 0;  // of their distances from the plane
  };
  std::vector<Support> support;  // of each plane
  static constexpr std::uint32_t kNoPlane = ~std::uint32_t{0};
};

// What counts as a plane. The standard band leaves a mesh on the plane the other half of epsilon.
struct PlaneThresholds {
  double band = 0.5;               // greatest distance of a point from its plane, over epsilon
  std::size_t least_points = 100;  // of a plane
};

// The planes that find_features() finds in the points. `check` is polled by any of the threads; an
// exception from it ends the search. The result is the same for any number of threads. O(n log n).
PlaneParts find_plane_parts(
    std::span<const Point> points, double epsilon, std::size_t threads,
    const std::function<void()>& check = [] {}, const PlaneThresholds& thresholds = {});

// The plane to which most of the five points nearest to each vertex belong, or kNoPlane. O(n log
// n).
std::vector<std::uint32_t> planes_of_vertices(std::span<const Point> vertices,
                                              const PlaneParts& parts, std::size_t threads);

// The plane that each triangle of a manifold mesh follows, or kNoPlane. A triangle whose vertices
// are of one plane (planes_of_vertices) follows it. From there each plane grows over triangles
// beside it that lie within `reach` of it, the nearest first: noise, outliers and the chamfers
// between planes follow one of them. O(n log n).
std::vector<std::uint32_t> planes_of_triangles(const TriangleMesh& mesh, const PlaneParts& parts,
                                               double reach, std::size_t threads);

// The first plane that all corners of a triangle are within `apart` of, or kNoPlane; for each
// triangle. O(triangles * planes).
std::vector<std::uint32_t> planes_under(const TriangleMesh& mesh, std::span<const Plane> planes,
                                        double apart);

}  // namespace emax
