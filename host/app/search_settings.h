#pragma once

#include <cstddef>

#include "host/app/commands.h"
#include "host/optimize/optimize.h"

namespace emax {

// Whether a search also bounds the mesh's distance from the reference. Throws Error if the
// decimator does not support such a bound.
bool is_two_sided(const OptimizeOptions& options);

// The settings of a search from the options and the configuration. Throws Error if they contradict
// each other, and as read_config() does.
OptimizeSettings search_settings(const OptimizeOptions& options);

// Whether one deep decimation is made instead of a search (decimates_deep_at_once()): by default,
// where nobody asked for another number of evaluations.
bool is_one_deep(const OptimizeOptions& options, std::size_t points);
// Sets budget, effort, limits and jobs, where they depend on the number of points.
void suit_to_cloud(OptimizeSettings& settings, const OptimizeOptions& options, std::size_t points);

// About how many seconds the search takes once the bound is made, for settings that suit the cloud.
// `logged`: evaluations that it need not repeat.
double expected_search_seconds(const OptimizeSettings& settings, const OptimizeOptions& options,
                               std::size_t points, std::size_t logged);

}  // namespace emax
