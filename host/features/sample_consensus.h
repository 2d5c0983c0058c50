#pragma once

#include <span>
#include <vector>

#include "host/features/neighbourhoods.h"
#include "host/features/region.h"

namespace emax {

// Cylinders and spheres among the points that no plane has, or only one that may be curved, by
// sample consensus (Fischler and Bolles 1981) within each smooth part of the graph of neighbours:
// two oriented points give a shape, some of the part's points vote for it, and least squares make
// the best one better. Planes that may be curved give way to a shape that has more points, and most
// of theirs: they are removed from `planes`. The points lie around the origin. A pure function of
// the arguments and the seed. O(n k) for each shape.
std::vector<Region> find_curved(std::span<const Point> points, const Neighbourhoods& near,
                                const FeatureOptions& options, std::vector<Region>& planes);

}  // namespace emax
