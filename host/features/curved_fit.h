#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "host/features/shapes.h"

namespace emax {

// The cylinder through two points with these unit normals, of either sign (Schnabel, Wahl and Klein
// 2007, "Efficient RANSAC for point-cloud shape detection"): its axis is perpendicular to both.
// Nothing where the normals are nearly parallel, or where the points are not at the same distance
// from the axis to within `band`.
std::optional<Cylinder> cylinder_through(const Point& a, const Point& normal_a, const Point& b,
                                         const Point& normal_b, double band);
// The sphere, likewise.
std::optional<Sphere> sphere_through(const Point& a, const Point& normal_a, const Point& b,
                                     const Point& normal_b, double band);

// The shape of least squares of the distances of these points, at least as many as the shape has
// parameters, from a shape near it, by Gauss and Newton. Nothing where it runs away. O(n).
std::optional<Cylinder> fit_cylinder(std::span<const Point> points,
                                     std::span<const std::uint32_t> members, Cylinder first);
std::optional<Sphere> fit_sphere(std::span<const Point> points,
                                 std::span<const std::uint32_t> members, Sphere first);

}  // namespace emax
