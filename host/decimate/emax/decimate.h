// Decimation under a certified bound: the fewest triangles that can be found within it.
//
//   #include <emax/decimate.h>
//
//   const emax::Decimation made = emax::decimate(mesh, {.max_error = 0.5});
//   save(made.surface);   // every point of either surface within 0.5 of the other, proven
//
// Links with emax::decimate. Source: section 2.2 and reference [6], which bounds nothing; method:
// docs/decisions/0010-the-bounded-decimator.md.
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
  // Every point of the cloud, and every point of the reference, stays within this of the result.
  double max_error = 0;
  // And every point of the result within this of the reference; 0: max_error.
  double max_back_error = 0;
  // False: points of the cloud alone are bounded; fewer triangles, which may leave the surface.
  bool two_sided = true;
  enum class Effort {
    kCollapse,  // edge collapses alone: a third of the time, about a tenth more triangles
    kNormal,    // and vertices moved, edges flipped
    kDeep,      // the same until nothing is gained: many times the time, a few percent fewer
  } effort = Effort::kNormal;
  // Edges over which the normals turn by more degrees stay, with their corners; 0: none.
  double feature_angle = 0;
  // Asked now and then; true ends the work with the mesh at hand, which keeps every bound.
  std::function<bool()> interrupted = nullptr;
  // Told now and then: a guess at the share of the work that is done, and the triangles left.
  std::function<void(double, std::size_t)> progress = nullptr;
};

// What was made and what is proven of it, by what emax/certify.h proves.
struct Decimation {
  Surface surface;
  double e_max = 0;  // an upper bound of the distance of the cloud's points, but for those left out
  std::optional<double> to_reference;    // of the surface's points to the reference; two-sided
  std::optional<double> from_reference;  // of the reference's points to the surface; two-sided
  std::vector<std::size_t> left_out;     // points that were farther than max_error at the start
  bool interrupted = false;
};

// The mesh is the reference, made manifold first: triangles that cannot be part of a manifold are
// dropped, and points of the cloud farther than max_error / 2 from it are joined to it. Without a
// cloud its vertices are the points. The result is manifold, consistently oriented, of the topology
// of the reference and free of intersections that the reference does not have. The same bytes for
// the same arguments. Threads may call at once.
//
// Throws Error for arguments that are no mesh and no cloud, for a bound that is not positive or
// within the roundings of the coordinates, and for a cloud that does not belong to the mesh.
// About O(n log n) in triangles and points.
EMAX_API Decimation decimate(SurfaceSpan mesh, const DecimateOptions& options);
EMAX_API Decimation decimate(SurfaceSpan mesh, Coordinates cloud, const DecimateOptions& options);

}  // namespace v1
}  // namespace emax
