#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "host/decimate/decimation_bound.h"
#include "host/optimize/optimize.h"

namespace emax {

// The bound that a run with the bounded decimator fixes before its search; with another decimator,
// one that bounds nothing. The reference is the surface that the method's standard values give, its
// holes filled, as a manifold, with the points inserted that are farther from it than epsilon / 2.
// Outliers are, of the points that `constraint` may exclude, those beyond epsilon of that surface.
// Both distances leave room for what storing moves.
//
// Reconstruction runs in a worker, the rest here. A pure function of cloud, constraint and
// settings. Throws Error where no reference can be made or the tolerance is lost to rounding, and
// Interrupted.
DecimationBound decimation_bound(std::span<const Point> cloud, ErrorConstraint& constraint,
                                 const OptimizeSettings& settings);

}  // namespace emax
