#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Points of a cloud farther than this from a surface become its vertices before it is decimated:
// half of epsilon, which leaves decimation room. Where more than 2% of the points are farther than
// that, noise is the reason; joining them would only make the surface rough, and it is 0.9 epsilon
// (docs/decisions/0014).
double joining_distance(double within_half, double epsilon);

// The same for a mesh and a cloud, by sampled_distances(); half of epsilon if either is empty.
double joining_distance(const TriangleMesh& mesh, std::span<const Point> cloud, double epsilon,
                        const std::function<bool()>& interrupted = nullptr);

// Upper bounds, a rounding from the distance, of at most 50,000 of the points, evenly chosen, from
// the mesh; of a point within `enough` some bound of at most that. O(log n) for each point. Empty
// where `interrupted` says so.
std::vector<double> sampled_distances(const TriangleMesh& mesh, std::span<const Point> cloud,
                                      double enough, const std::function<bool()>& interrupted);

// The share of the distances, at least one, that are greater.
double share_beyond(std::span<const double> distances, double most);

}  // namespace emax
