#pragma once

#include <span>
#include <vector>

#include "host/features/neighbourhoods.h"
#include "host/features/region.h"

namespace emax {

// Planes of a cloud whose points lie around the origin. Regions do not share points. They come in
// the order in which they were found. A pure function of the arguments, for any number of threads.

// By region growing: from the points whose neighbourhoods are the flattest on (Rabbani, van den
// Heuvel and Vosselman 2006, "Segmentation of point clouds using smoothness constraint", of which
// the order is). O(n log n + n k).
std::vector<Region> grow_planes(std::span<const Point> points, const Neighbourhoods& near,
                                const FeatureOptions& options);

// By a Hough transform in two steps (the steps of Rabbani and van den Heuvel 2005): oriented points
// vote for the cell of their normal on a hemisphere, and in the order of the votes the points of
// each cell vote for the distance of their plane from the origin. A peak gives a plane, which its
// points improve, and each connected part of the points on it is a region. O(n log n + n k + n d)
// for d directions with planes.
std::vector<Region> hough_planes(std::span<const Point> points, const Neighbourhoods& near,
                                 const FeatureOptions& options);

}  // namespace emax
