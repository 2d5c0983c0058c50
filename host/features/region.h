#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/features/shapes.h"

namespace emax {

inline constexpr std::uint32_t kNoRegion = ~std::uint32_t{0};

// A connected part of a cloud on one shape.
struct Region {
  Shape shape;
  std::vector<std::uint32_t> points = {};  // their numbers, ascending: the support
  double rms = 0;                          // of their distances from the shape
  // Around the points, on a plane or a cylinder; empty where they are on a line of it (outline.h).
  std::vector<Point> outline = {};
  double area = 0;  // inside of the outline; of a sphere, of the cap that holds the points
  // A plane so small, or of points so sparse, that they would not show it if it was curved.
  bool may_be_curved = false;
};

// Sets the rms.
inline void measure(Region& region, std::span<const Point> points) {
  double squares = 0;
  for (const std::uint32_t i : region.points) {
    squares += std::pow(distance(region.shape, points[i]), 2);
  }
  region.rms = std::sqrt(squares / static_cast<double>(region.points.size()));
}

// Points that are spread evenly over the band, as those of noise are, have 0.58 of it as their rms.
// No shape has more than this.
inline constexpr double kGreatestRms = 0.5;  // of the band

// What is searched and how closely. Lengths in the unit of the points.
struct FeatureOptions {
  double band = 0;     // farthest that a point of a region lies from its shape
  double noise = 0;    // standard deviation of the points across the surface
  double spacing = 0;  // of the points
  // A neighbourhood turned by more from a shape does not fit it (radians).
  double angle = 0.35;
  // A surface that turns by more from end to end is no plane (radians): Turning.
  double greatest_turning = 0.05;
  std::size_t neighbours = 16;      // of each point
  std::size_t least_support = 100;  // points of a region
  std::uint64_t seed = 1;           // of the sample consensus
  std::size_t threads = 1;          // they change no byte of the result
  // Called now and then, from any of the threads; an exception from it ends the search.
  std::function<void()> check = [] {};
};

}  // namespace emax
