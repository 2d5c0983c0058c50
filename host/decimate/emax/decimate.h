// Decimation under a certified bound: the fewest triangles that can be found within it.
//
//   #include <emax/decimate.h>
//
//   const emax::Decimation made = emax::decimate(mesh, {.max_error = 0.5});
//   save(made.surface);   // every point of either surface within 0.5 of the other, proven
//
// Links with emax::decimate. Source: section 2.2 and reference [6], whose decimation has no bound.
// Method: docs/decisions/0010-the-bounded-decimator.md.
#pragma once

#include <emax/error.h>
#include <emax/surface.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace emax {
inline namespace v1 {

struct DecimateOptions {
  // Greatest distance of points of the cloud and of the reference from the result.
  double max_error = 0;
  // Greatest distance of points of the result from the reference; 0: max_error.
  double max_back_error = 0;
  // False bounds only the points of the cloud. The result has fewer triangles, which may be far
  // from the reference.
  bool two_sided = true;
  enum class Effort {
    kCollapse,  // only edge collapses: half of the time, up to four tenths more triangles
    kNormal,    // also moves vertices, flips edges and spreads the error evenly
    kDeep,  // like kNormal until nothing is gained: twice the time and more, a few percent fewer
  } effort = Effort::kNormal;
  // Edges over which the normals turn by more than this stay within epsilon, and their corners in
  // place. In degrees; 0: none.
  double feature_angle = 0;
  // Threads to work with. The result is the same for any number.
  std::size_t threads = 1;
  // Called from time to time; true ends the work with the mesh reached so far, which keeps every
  // bound.
  std::function<bool()> interrupted = nullptr;
  // Called from time to time with an estimate of the share of the work that is done, and the
  // triangles left.
  std::function<void(double, std::size_t)> progress = nullptr;
};

// The result, with the proofs of emax/certify.h.
struct Decimation {
  Surface surface;
  double e_max = 0;  // upper bound of the distance of the cloud's points, except those in left_out
  std::optional<double> to_reference;    // of the surface's points to the reference, if two-sided
  std::optional<double> from_reference;  // of the reference's points to the surface, if two-sided
  std::vector<std::size_t> left_out;     // points that were farther than max_error at the start
  bool interrupted = false;
};

// The mesh is the reference. First it is made manifold: triangles that cannot be part of a manifold
// are dropped, and points of the cloud farther than max_error / 2 from it are joined to it. Without
// a cloud its vertices are the points. The result is manifold, consistently oriented, of the
// topology of the reference, and has no intersections that the reference does not have. The same
// arguments give the same bytes. Several threads may call at once.
//
// Throws Error for arguments that are not a mesh or not a cloud, for a bound that is not positive
// or is within the roundings of the coordinates, and for a cloud that does not belong to the mesh.
// About O(n log n) in triangles and points.
EMAX_API Decimation decimate(SurfaceSpan mesh, const DecimateOptions& options);
EMAX_API Decimation decimate(SurfaceSpan mesh, Coordinates cloud, const DecimateOptions& options);

}  // namespace v1
}  // namespace emax
