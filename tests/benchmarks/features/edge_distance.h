#pragma once

#include <cstddef>
#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// How far the sharp edges of a surface that is known are from the edges of a mesh.
struct EdgeDistance {
  std::size_t samples = 0;
  double mean = 0, p95 = 0;  // p95: of 95 % of the samples, at most
  double within_half = 0;    // share of the samples within half of the band
};

// Samples, `band` apart, of the edges of `truth` at which it turns by more than 40 degrees, if the
// cloud has a point within `band` of the sample; each to the nearest edge of `mesh` at which it
// turns by more than 20. Farther than ten bands counts as ten bands. All with all: O(samples *
// edges).
EdgeDistance distance_of_edges(const TriangleMesh& truth, const TriangleMesh& mesh,
                               std::span<const Point> cloud, double band);

}  // namespace emax::benchmarks
