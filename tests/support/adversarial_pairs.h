#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "sw_model/model/triangle_frame.h"
#include "tests/support/stimuli.h"

namespace emax::test {

// Triangles of every shape, and points where a distance computed with rounding is likely to be
// wrong: for searches of counterexamples to error bounds.

struct Pair {
  std::array<Point, 3> corners;
  Point p;  // already binary32
};

inline Point to_binary32(const Point& p) { return p.cast<float>().cast<double>(); }

inline Vector3<float> kernel_point(const Point& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

inline Point any_direction(Random& random) {
  Point d;
  do {
    d = random.point(-1, 1);
  } while (d.norm() < 0.1);
  return d.normalized();
}

inline double log_uniform(Random& random, double low, double high) {
  return std::pow(10.0, random.uniform(low, high));
}

struct Family {
  std::string name;
  std::function<std::array<Point, 3>(Random&)> triangle;
};

// A base of length 1 on the z axis and an apex; turned, scaled, moved and with its corners in any
// order afterwards.
inline std::array<Point, 3> base_and_apex(double apex_y, double apex_z) {
  return {Point(0, 0, 0), Point(0, 0, 1), Point(0, apex_y, apex_z)};
}

// Where along the base: often next to an end.
inline double foot_of_apex(Random& random) {
  const double t = random.uniform(0, 1);
  const double near_end = log_uniform(random, -7, -0.5);
  switch (random.below(3)) {
    case 0:
      return t;
    case 1:
      return near_end;
    default:
      return 1 - near_end;
  }
}

inline const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"any",
       [](Random& r) {
         return std::array<Point, 3>{r.point(-1, 1), r.point(-1, 1), r.point(-1, 1)};
       }},
      {"sliver",
       [](Random& r) {
         const double height = log_uniform(r, -6, -4);
         return base_and_apex(height, foot_of_apex(r));
       }},
      {"at the sliver ratio",
       [](Random& r) {
         const double height = kSliverRatio * r.uniform(0.999, 1.001);
         return base_and_apex(height, foot_of_apex(r));
       }},
      {"below the sliver ratio",
       [](Random& r) {
         const double height = log_uniform(r, -9, -6);
         return base_and_apex(height, foot_of_apex(r));
       }},
      {"needle",
       [](Random& r) {
         const double angle = r.uniform(0, 3.14159265358979), side = log_uniform(r, -6, -1);
         return base_and_apex(side * std::sin(angle), 1 - side * std::cos(angle));
       }},
      {"obtuse",
       [](Random& r) {
         const double height = log_uniform(r, -3, -0.5);
         return base_and_apex(height, r.uniform(0.1, 0.9));
       }},
      {"isosceles", [](Random& r) {
         const double angle = log_uniform(r, -6, 0);
         return base_and_apex(std::sin(angle), std::cos(angle));
       }}};
  return all;
}

// Near a vertex, an edge or its extension, the plane, or far: at every scale.
inline Point adversarial_point(Random& random, const std::array<Point, 3>& corners) {
  const std::size_t i = random.below(3);
  const Point& a = corners[i];
  const Point& b = corners[(i + 1) % 3];
  const Point& c = corners[(i + 2) % 3];
  const double size = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  const double far = log_uniform(random, -9, 0.5), in_plane_far = log_uniform(random, -9, 0.5);
  const Point off = size * far * any_direction(random);
  const double along_ab = random.uniform(-1, 1), along_ac = random.uniform(-1, 1);
  const Point in_plane_off = in_plane_far * (along_ab * (b - a) + along_ac * (c - a));
  switch (random.below(6)) {
    case 0:
      return a + off;
    case 1:
      return a + random.uniform(-0.5, 1.5) * (b - a) + off;
    case 2:
      return a + in_plane_off;
    case 3: {
      const double along_b = random.uniform(0, 0.5), along_c = random.uniform(0, 0.5);
      return a + along_b * (b - a) + along_c * (c - a) + off;
    }
    case 4: {  // beside a sliver in its plane, where two edges show almost the same
      const TriangleFrame frame = make_frame(corners);
      const double across = size * random.uniform(-1, 1), reach = size * log_uniform(random, -5, 0);
      const double along = reach * random.uniform(-1, 1);
      return eigen(frame.record.v1) + (frame.v3.z + along) * eigen(frame.record.along) +
             across * eigen(frame.record.in_plane);
    }
    default: {
      const double away = log_uniform(random, 0, 3) * size;
      return a + away * any_direction(random);
    }
  }
}

inline Pair random_pair(Random& random, const Family& family) {
  std::array<Point, 3> corners = family.triangle(random);
  const double angle = random.uniform(0, 6.28);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, any_direction(random)).toRotationMatrix();
  const double scale = random.below(4) == 0 ? log_uniform(random, -9, 0) : random.uniform(0.1, 2);
  // At the origin V1 costs nothing; at 2^32 it costs everything.
  const double distance = random.below(2) == 0 ? 0 : log_uniform(random, -3, 9.4);
  const Point move = distance * any_direction(random);
  for (Point& corner : corners) corner = scale * (turn * corner) + move;
  if (random.below(2) == 0) {
    const Point v1 = eigen(make_frame(corners).record.v1);
    if (distance == 0) {
      for (Point& corner : corners) corner -= v1;
    }
  }
  std::rotate(corners.begin(), corners.begin() + random.below(3), corners.end());
  if (random.below(2) == 0) std::swap(corners[0], corners[1]);
  return {corners, to_binary32(adversarial_point(random, corners))};
}

inline Pair neighbour(Random& random, const Pair& from) {
  Pair to = from;
  const double size =
      (from.corners[1] - from.corners[0]).norm() + (from.corners[2] - from.corners[0]).norm();
  if (random.below(2) == 0) {
    Point& corner = to.corners[random.below(3)];
    corner += size * log_uniform(random, -8, -1) * any_direction(random);
  }
  to.p = to_binary32(to.p + size * log_uniform(random, -8, -1) * any_direction(random));
  return to;
}

}  // namespace emax::test
