#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Which points of a cloud become vertices of a surface before it is decimated.
struct JoiningDistance {
  JoiningDistance() = default;
  // All that are farther than this.
  JoiningDistance(double far)  // NOLINT(google-explicit-constructor)
      : with_others(far), alone(far) {}
  JoiningDistance(double far_with_others, double far_alone)
      : with_others(far_with_others), alone(far_alone) {}

  // Points farther than this, but where three quarters of them are alone, only those that are not:
  // with another one among the 8 nearest, on the same side of the surface.
  double with_others = 0;
  double alone = 0;  // and all that are farther than this, which is at least with_others
};

// Half of epsilon, which leaves decimation room, and 0.9 epsilon for points alone: where those are
// three quarters, noise is the reason, and joining them would only make the surface rough. Where
// more than 2% of the points are farther than half of epsilon, both are 0.9 epsilon
// (docs/decisions/0014).
JoiningDistance joining_distance(double within_half, double epsilon);

// The same for a mesh and a cloud, by sampled_distances(); half of epsilon if either is empty.
JoiningDistance joining_distance(const TriangleMesh& mesh, std::span<const Point> cloud,
                                 double epsilon,
                                 const std::function<bool()>& interrupted = nullptr);

// Upper bounds, a rounding from the distance, of at most 50,000 of the points, evenly chosen, from
// the mesh; of a point within `enough` some bound of at most that. O(log n) for each point. Empty
// where `interrupted` says so.
std::vector<double> sampled_distances(const TriangleMesh& mesh, std::span<const Point> cloud,
                                      double enough, const std::function<bool()>& interrupted);

// The share of the distances, at least one, that are greater.
double share_beyond(std::span<const double> distances, double most);

}  // namespace emax
