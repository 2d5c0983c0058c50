#pragma once

#include <algorithm>
#include <array>

#include "sw_model/base/mesh_view.h"

namespace emax::test {

// Distance from a point to a triangle with at least 64 binary digits: a reference for what works
// in 53 or 24. Any shape; wrong by a few 2^-63 of |P - V| plus the triangle's size.
inline long double long_double_distance(const Point& point, const std::array<Point, 3>& corners) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const Vector p = point.cast<long double>();
  std::array<Vector, 3> v, edge;
  for (std::size_t i = 0; i < 3; ++i) v[i] = corners[i].cast<long double>() - p;
  for (std::size_t i = 0; i < 3; ++i) edge[i] = v[(i + 1) % 3] - v[i];

  long double least = std::min({v[0].norm(), v[1].norm(), v[2].norm()});
  for (std::size_t i = 0; i < 3; ++i) {
    const long double t = -v[i].dot(edge[i]) / edge[i].squaredNorm();
    if (t > 0 && t < 1) least = std::min(least, (v[i] + t * edge[i]).norm());
  }
  const std::size_t i =
      static_cast<std::size_t>(std::max_element(edge.begin(), edge.end(),
                                                [](const Vector& a, const Vector& b) {
                                                  return a.squaredNorm() < b.squaredNorm();
                                                }) -
                               edge.begin());
  const Vector along = edge[i].normalized(), to_apex = -edge[(i + 2) % 3];
  const Vector height = to_apex - to_apex.dot(along) * along;
  const Vector across = -v[i] + v[i].dot(along) * along;
  const long double apex = across.dot(height) / height.squaredNorm();
  const long double position = (-v[i] - apex * to_apex).dot(along) / edge[i].norm();
  if (apex > 0 && position > 0 && apex + position < 1) {
    least = std::min(least, (v[i] + apex * to_apex + position * edge[i]).norm());
  }
  return least;
}

}  // namespace emax::test
