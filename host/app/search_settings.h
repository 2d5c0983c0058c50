#pragma once

#include <cstddef>

#include "host/app/commands.h"
#include "host/optimize/optimize.h"

namespace emax {

// Whether a search bounds the mesh from the reference too. Throws Error where the decimator cannot
// keep such a bound.
bool is_two_sided(const OptimizeOptions& options);

// What the options and the configuration say of a search. Throws Error where they contradict each
// other and as read_config() does.
OptimizeSettings search_settings(const OptimizeOptions& options);

// Budget, limits and jobs, as far as they depend on the number of points.
void suit_to_cloud(OptimizeSettings& settings, const OptimizeOptions& options, std::size_t points);

}  // namespace emax
