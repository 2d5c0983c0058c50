#pragma once

#include <cstddef>
#include <span>

#include "host/geometry/triangle_mesh.h"
#include "tests/benchmarks/features/plane_tools.h"

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

// The same for a scan whose surface is not known: samples, `band` / 2 apart, of the lines where two
// planes meet at more than 40 degrees, if both have a point within two bands of the sample and
// `reference` is within `band` of it. O(planes^2 * points of a plane + samples * edges).
EdgeDistance distance_of_meeting_planes(std::span<const FoundPlane> planes,
                                        std::span<const Point> cloud, const TriangleMesh& reference,
                                        const TriangleMesh& mesh, double band);

}  // namespace emax::benchmarks
