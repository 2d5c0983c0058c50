#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "tests/support/stimuli.h"

namespace emax::test {

// All coordinates are multiples of this, so that a shift by a whole number up to 1e7 is exact.
inline constexpr double kGrain = 0x1p-20;

inline Point grained(const Point& p) { return (p / kGrain).array().round().matrix() * kGrain; }

inline std::vector<Point> moved(std::vector<Point> points, const Point& by) {
  for (Point& p : points) p += by;
  return points;
}

// Fibonacci points on a sphere of radius 1.
inline std::vector<Point> sphere_cloud(int n) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2.0 * i + 1) / n;
    const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    points.push_back(grained({r * std::cos(turn), r * std::sin(turn), z}));
  }
  return points;
}

// Torus of radii 1 and 0.4, rings x segments points.
inline std::vector<Point> torus_cloud(int rings, int segments) {
  std::vector<Point> points;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      // Every second ring is turned by half a step: no four points lie on one circle.
      const double u = 2 * std::numbers::pi * i / rings;
      const double v = 2 * std::numbers::pi * (j + 0.5 * (i % 2)) / segments;
      const double r = 1 + 0.4 * std::cos(v);
      points.push_back(grained({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)}));
    }
  }
  return points;
}

// The square [-1, 1]² at z = 0, n x n slightly scattered points, none within `hole` of the middle.
inline std::vector<Point> square_cloud(int n, double hole, std::uint64_t seed) {
  Random random(seed);
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double step = 2.0 / (n - 1);
      const Point p(-1 + step * (i + random.uniform(-0.2, 0.2)),
                    -1 + step * (j + random.uniform(-0.2, 0.2)), 0);
      if (p.norm() > hole) points.push_back(grained(p));
    }
  }
  return points;
}

// Positive when the closed surface is oriented outward.
inline double signed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  const Point origin = mesh.vertices.front();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    volume += (a - origin).dot((b - origin).cross(c - origin)) / 6;
  }
  return volume;
}

inline bool same_bytes(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

}  // namespace emax::test
