#pragma once

#include <vector>

#include "host/decimate/back_bound.h"

namespace emax {

// A place on an edge, and the triangle of the reference nearest to it.
struct EdgePlace {
  double along;  // share of the way
  BackBound::Sight sight;
};

struct EdgeEnd {
  Point at;
  BackBound::Sight sight;
};

// The places between the ends at which the distance to the reference is a local maximum and at
// least half of the greatest one, in their order along the edge: one to eight, the farthest.
//
// Where the distances along the edge are a parabola, as over a smooth reference, this is its
// extremum. Else the maxima are sought over the edges of the reference below, and near these: the
// distance to one triangle is convex, so that between two places the reference is no farther than
// where the chords of the distances to the two nearest triangles cross. Distances between the
// places are at most a few hundredths greater. O(triangles of the reference along the edge).
std::vector<EdgePlace> farthest_places(const BackBound& reference, const EdgeEnd& from,
                                       const EdgeEnd& to);

}  // namespace emax
