#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "host/optimize/optimize.h"
#include "host/optimize/reference_fit.h"
#include "host/parameters/decimation_bound.h"

namespace emax {

// The bound that a run with the bounded decimator fixes before its search; with another decimator,
// one that bounds nothing. The reference is the surface that fit_reference() makes of the cloud,
// with the points joined that are farther from it than epsilon / 2, or than 0.9 epsilon where more
// than 2 % of them are. With features its flat holes are closed before that. Outliers are, of the
// points that `constraint` may exclude, those beyond epsilon of the surface. Both distances leave
// room for what storing moves. `made`, if given, learns how the reference was made.
//
// Reconstruction runs in workers, the rest here. A pure function of cloud, constraint and settings.
// Throws Error where no reference can be made or the tolerance is lost to rounding, and
// Interrupted.
DecimationBound decimation_bound(std::span<const Point> cloud, ErrorConstraint& constraint,
                                 const OptimizeSettings& settings, ReferenceFit* made = nullptr);

}  // namespace emax
