#include "tests/support/scan_generator/scene.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "host/geometry/bounds.h"
#include "host/geometry/merge_vertices.h"

namespace emax::test {
namespace {

constexpr double kEyeHeight = 1.6;  // of the scanner's mirror above the ground

class Builder {
 public:
  void quad(const Point& a, const Point& b, const Point& c, const Point& d) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Point& p : {a, b, c, d}) mesh_.vertices.push_back(p);
    mesh_.triangles.push_back({first, first + 1, first + 2});
    mesh_.triangles.push_back({first, first + 2, first + 3});
  }

  void box(const Point& low, const Point& high) {
    const auto corner = [&](int i) {
      return Point((i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                   (i & 4) != 0 ? high[2] : low[2]);
    };
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& f : faces) quad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
  }

  // The side of a cylinder from `from` to `to`.
  void tube(const Point& from, const Point& to, double radius, int sides) {
    const Point axis = (to - from).normalized();
    const Point across = axis.unitOrthogonal(), other = axis.cross(across);
    const auto offset = [&](int i) -> Point {
      const double angle = 2 * std::numbers::pi * i / sides;
      return radius * (std::cos(angle) * across + std::sin(angle) * other);
    };
    for (int i = 0; i < sides; ++i) {
      quad(from + offset(i), from + offset(i + 1), to + offset(i + 1), to + offset(i));
    }
  }

  TriangleMesh take() {
    merge_equal_vertices(mesh_.vertices, mesh_.triangles);
    return std::move(mesh_);
  }

 private:
  TriangleMesh mesh_;
};

double height_of_terrain(double x, double y) {
  return 6 * std::sin(x / 23) * std::cos(y / 31) + 2 * std::sin(x / 7 + 1) * std::sin(y / 9) +
         0.4 * std::cos(x / 1.9) * std::sin(y / 2.3 + x / 5);
}

}  // namespace

Scene hall() {
  constexpr double kLength = 40, kWidth = 20, kHeight = 8;
  Builder builder;
  builder.box({0, 0, 0}, {kLength, kWidth, kHeight});
  for (int i = 0; i < 6; ++i) {
    for (const double y : {5.0, 15.0}) {
      const double x = 4 + 6.4 * i;
      builder.tube({x, y, 0}, {x, y, kHeight}, 0.35, 48);
    }
  }
  constexpr int kSteps = 12;
  for (int i = 0; i < kSteps; ++i) {
    builder.box({34 + 0.3 * i, 8, 0}, {34 + 0.3 * (i + 1), 12, 0.17 * (i + 1)});
  }
  for (const double y : {3.0, 3.5, 17.0}) {
    builder.tube({0, y, 7.2}, {kLength, y, 7.2}, y == 3.5 ? 0.06 : 0.15, 24);
  }
  return {
      builder.take(),
      {{6, 10, kEyeHeight}, {20, 2.2, kEyeHeight}, {20, 17.5, kEyeHeight}, {31, 10, kEyeHeight}}};
}

Scene terrain() {
  constexpr int kCells = 400;
  constexpr double kCell = 0.5, kHalf = kCells * kCell / 2;
  Scene scene;
  const auto at = [&](double x, double y) { return Point(x, y, height_of_terrain(x, y)); };
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      scene.mesh.vertices.push_back(at(i * kCell - kHalf, j * kCell - kHalf));
    }
  }
  const auto index = [](int i, int j) { return static_cast<std::uint32_t>(i * (kCells + 1) + j); };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      scene.mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      scene.mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  for (const auto& [x, y] : {std::pair(-50.0, -40.0), {45.0, -55.0}, {40.0, 50.0}, {-35.0, 60.0}}) {
    scene.stations.push_back(at(x, y) + Point(0, 0, kEyeHeight));
  }
  return scene;
}

Scene statue(TriangleMesh mesh) {
  const Bounds box = bounds_of(mesh.vertices);
  const Point size = box.upper - box.lower;
  constexpr double kHeight = 2;
  const Point foot = {box.midpoint()[0], box.midpoint()[1], box.lower[2]};
  for (Point& v : mesh.vertices) v = (v - foot) * (kHeight / size[2]);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  constexpr double kGround = 6;
  for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.vertices.emplace_back(kGround * x, kGround * y, 0);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  return {std::move(mesh),
          {{4, 0, kEyeHeight},
           {0, 4, kEyeHeight},
           {-4, 0, kEyeHeight},
           {0, -4, kEyeHeight},
           {2.5, 2.5, 4}}};
}

}  // namespace emax::test
