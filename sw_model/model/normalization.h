#pragma once

#include <array>
#include <span>
#include <vector>

#include "hls/kernel/scalar.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// normalised = (file - origin) * scale, origin = midpoint of the cloud's bounding box, scale = the
// power of two that brings the largest half-extent into (1/2, 1]. It depends on the cloud alone.
struct Normalization {
  Point origin = Point::Zero();
  double scale = 1;

  Point apply(const Point& p) const { return (p - origin) * scale; }
  Point invert(const Point& p) const { return p / scale + origin; }
  double length(double file_units) const { return file_units * scale; }
};

// Coordinates farther than this from the origin, normalised, are refused: beyond it squares of
// distances could overflow binary32.
constexpr double kMaxNormalizedCoordinate = 0x1p32;

// Throws std::invalid_argument for an empty cloud or one that is not finite.
Normalization normalization_of(std::span<const Point> cloud);

// Of a cloud in this box, whose corners are finite.
Normalization normalization_of_box(const Point& lower, const Point& upper);

// The cloud as the kernel reads it: normalised in double, rounded once to binary32. O(n).
std::vector<Vector3<float>> normalized_points(std::span<const Point> cloud,
                                              const Normalization& normalization);

}  // namespace emax
