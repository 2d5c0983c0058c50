#pragma once

#include <cstddef>
#include <vector>

#include "host/features/shapes.h"
#include "tests/support/stimuli.h"

namespace emax::test {

// A parallelogram from `corner` along `u` and `v`.
struct Patch {
  Point corner, u, v;

  Plane plane() const;
};

// Points spread evenly at random, moved by `noise` (standard deviation) along the normal.
void scan_patch(const Patch& patch, std::size_t points, double noise, Random& random,
                std::vector<Point>& cloud);
// The sides of a box.
std::vector<Patch> sides_of_box(const Point& lower, const Point& upper);
// The side of a cylinder over `length` along its axis from its centre, turned by `angle` at most.
void scan_cylinder(const Cylinder& cylinder, double length, double angle, std::size_t points,
                   double noise, Random& random, std::vector<Point>& cloud);
void scan_sphere(const Sphere& sphere, std::size_t points, double noise, Random& random,
                 std::vector<Point>& cloud);

// Standard normal.
double gaussian(Random& random);

}  // namespace emax::test
