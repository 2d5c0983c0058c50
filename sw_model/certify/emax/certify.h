// Proofs of distances, in binary64 with outward rounding: what may be promised of a mesh.
//
//   #include <emax/certify.h>
//
//   const emax::CertifiedPoints points = emax::certify_points(cloud, mesh);
//   const emax::CertifiedDistance back = emax::certify_distance(mesh, reference);
//   const bool kept = points.upper <= 0.5 && back.upper <= 0.5;
//
// Links with emax::certify. Shares no code with the kernel and its engine (emax/measure.h). Several
// threads may call at once. Method: docs/numerics.md, "The oracle's rounding" and "From surface to
// surface"; source: section 4.
#pragma once

#include <emax/error.h>
#include <emax/surface.h>

#include <array>
#include <cstddef>

namespace emax {
inline namespace v1 {

// e_max lies between the two; they differ by rounding alone.
struct CertifiedPoints {
  double lower = 0, upper = 0;
  std::size_t worst_point = 0;  // the lowest index of a point that attains `upper`
};

// The greatest distance from a point of the cloud to the mesh, the same to the bit for any number
// of threads. Throws Error for arguments that are no cloud or no mesh, and for coordinates beyond
// 1e150. About O(points log triangles).
EMAX_API CertifiedPoints certify_points(Coordinates cloud, SurfaceSpan mesh,
                                        std::size_t threads = 1);

// Both ends are proven.
struct CertifiedDistance {
  double lower = 0, upper = 0;
  std::array<double, 3> witness = {};  // a point of `from` at least `lower` away
  std::size_t triangle = 0;            // of `from`, on which the witness lies
};

// The greatest distance from any point of `from`, the inside of its triangles included, to `to`.
// `upper` is at most lower * (1 + relative), or as near as roundings permit. Throws Error as
// certify_points does. A query of O(log triangles) for each vertex and for each cut of the search.
EMAX_API CertifiedDistance certify_distance(SurfaceSpan from, SurfaceSpan to,
                                            double relative = 0.01);

// Whether that distance is at most `limit`; faster than computing the distance. Also throws Error
// for a limit that is negative or not finite.
EMAX_API bool certify_within(SurfaceSpan from, SurfaceSpan to, double limit);

}  // namespace v1
}  // namespace emax
