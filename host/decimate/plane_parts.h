#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/features/shapes.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// Planes that a surface follows in parts, and the points of a scan that show where; cylinders and
// spheres, too, where they are asked for. Their numbers follow those of the planes.
struct PlaneParts {
  std::vector<Plane> planes;
  std::vector<Shape> curved;
  std::vector<Point> points;
  std::vector<std::uint32_t> plane_of;  // of each point, or the curved shape; kNoPlane: of none
  struct Support {
    std::size_t points = 0;
    double rms = 0;  // of their distances from the shape
  };
  std::vector<Support> support;  // of each plane and curved shape
  static constexpr std::uint32_t kNoPlane = ~std::uint32_t{0};

  bool empty() const { return planes.empty() && curved.empty(); }
  std::vector<Shape> shapes() const;  // by their numbers
};

// What counts as a plane. The standard band leaves a mesh on the plane the other half of epsilon.
struct PlaneThresholds {
  double band = 0.5;               // greatest distance of a point from its plane, over epsilon
  std::size_t least_points = 100;  // of a plane
  bool curved = false;             // cylinders and spheres, too
};

// The planes, or all shapes, that find_features() finds in the points. `check` is polled by any of
// the threads; an exception from it ends the search. The result is the same for any number of
// threads. O(n log n).
PlaneParts find_plane_parts(
    std::span<const Point> points, double epsilon, std::size_t threads,
    const std::function<void()>& check = [] {}, const PlaneThresholds& thresholds = {});

// The plane to which most of the five points nearest to each vertex belong, or kNoPlane. O(n log
// n).
std::vector<std::uint32_t> planes_of_vertices(std::span<const Point> vertices,
                                              const PlaneParts& parts, std::size_t threads);

// The plane or curved shape that each triangle of a manifold mesh follows, or kNoPlane. A triangle
// whose vertices are of one plane (planes_of_vertices) follows it. From there each plane grows over
// triangles beside it that lie within `reach` of it, the nearest first: noise, outliers and the
// chamfers between planes follow one of them. O(n log n).
std::vector<std::uint32_t> planes_of_triangles(const TriangleMesh& mesh, const PlaneParts& parts,
                                               double reach, std::size_t threads);

// Multiples of the tolerance: as a surface that follows a shape is within one of it, the middle of
// a triangle with its corners on the shape may be so far from it.
inline constexpr double kBesideShape = 2;

// The first shape that all corners of a triangle are within `apart` of, and its middle within
// `reach`, or kNoPlane; for each triangle. The middle tells the end of a cylinder, whose corners
// are on its rim, from its side. O(triangles * shapes).
std::vector<std::uint32_t> shapes_under(const TriangleMesh& mesh, std::span<const Shape> shapes,
                                        double apart, double reach);

}  // namespace emax
