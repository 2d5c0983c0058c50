#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "tests/benchmarks/features/plane_tools.h"

namespace emax::benchmarks {

// The planes of a surface that is known, and the points of a scan that belong to each.
struct PlaneTruth {
  struct KnownPlane {
    Plane plane;
    std::vector<std::uint32_t> points;
  };
  std::vector<KnownPlane> planes;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> plane_of;  // of each point
};

// The planes of a mesh's facets: connected triangles whose corners are within `flatness`, in widths
// of the mesh, of one plane; at least what its coordinates are rounded to. Facets on equal planes
// are of one, whether or not they touch. A facet that meets another at less than 20 degrees is part
// of a curved surface, and of no plane, unless its own corners tell that it is flat. A point
// belongs to the plane of the triangle nearest to it, if that is within `reach`.
PlaneTruth truth_of(const TriangleMesh& mesh, std::span<const Point> cloud, double reach,
                    double flatness = 1e-5);

// What a tool found beside what is there.
struct PlaneScore {
  std::size_t known = 0, found = 0;             // planes of `least` points or more
  std::size_t reported = 0, wrong = 0;          // by the tool: all of its planes
  double greatest_angle = 0, mean_angle = 0;    // degrees, of those found
  double greatest_offset = 0, mean_offset = 0;  // at the middle of the known plane's points
};

// A known plane is found where a reported one has at least half of its points, and at least half of
// that one's points are its own (Hoover et al. 1996, "An experimental comparison of range image
// segmentation algorithms", with the tolerance 0.5). A reported plane is wrong where no known
// plane, however small, has half of its points.
PlaneScore score_of(const PlaneTruth& truth, std::span<const Point> cloud,
                    std::span<const FoundPlane> reported, std::size_t least);

}  // namespace emax::benchmarks
