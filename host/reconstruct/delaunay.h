#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// The triangles of the Delaunay triangulation of points in a plane whose circumscribed circles have
// at most the radius `reach`: the alpha shape (Edelsbrunner, Kirkpatrick and Seidel, "On the shape
// of a set of points in the plane", 1983). Anticlockwise. Points count as rounded to 2^-29 of their
// width; of those that then coincide only the first has triangles. Of points on one circle any
// triangulation. None for points on a line. O(n log n).
std::vector<Triangle> alpha_shape(std::span<const Eigen::Vector2d> points, double reach);

}  // namespace emax
