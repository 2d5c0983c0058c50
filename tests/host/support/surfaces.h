#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {

inline TriangleMesh bumpy(std::uint32_t rings, std::uint32_t segments) {
  const Stimulus sphere = bumpy_sphere(rings, segments, 0, 1);
  return {sphere.vertices, sphere.triangles};
}

// The square [-1, 1]^2 as a wavy sheet of n x n vertices.
inline TriangleMesh sheet(std::uint32_t n, double height) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double x = -1 + 2.0 * i / (n - 1), y = -1 + 2.0 * j / (n - 1);
      mesh.vertices.push_back({x, y, height * std::sin(3 * x + 1) * std::cos(4 * y)});
    }
  }
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t at = i * n + j;
      mesh.triangles.push_back({at, at + n, at + n + 1});
      mesh.triangles.push_back({at, at + n + 1, at + 1});
    }
  }
  return mesh;
}

// The cube [-1, 1]^3, n x n squares a side.
inline TriangleMesh cube(std::uint32_t n) {
  TriangleMesh mesh;
  const auto vertex = [&](const Point& p) {
    const auto known = std::find(mesh.vertices.begin(), mesh.vertices.end(), p);
    if (known == mesh.vertices.end()) {
      mesh.vertices.push_back(p);
      return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }
    return static_cast<std::uint32_t>(known - mesh.vertices.begin());
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](std::uint32_t i, std::uint32_t j) {
        Point p;
        p[axis] = side;
        p[(axis + 1) % 3] = (2.0 * i - n) / n;
        p[(axis + 2) % 3] = side * (2.0 * j - n) / n;
        return vertex(p);
      };
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
          mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
      }
    }
  }
  return mesh;
}

// A cylinder of radius 1 between the planes z = -1 and 1, which close it.
inline TriangleMesh can(std::uint32_t around, std::uint32_t high) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= high; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      mesh.vertices.push_back({std::cos(angle), std::sin(angle), 2.0 * i / high - 1});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * around + j % around; };
  for (std::uint32_t i = 0; i < high; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  // Rings that end in a middle close bottom and top.
  constexpr std::uint32_t kRings = 8;
  for (const bool top : {false, true}) {
    std::vector<std::uint32_t> outer, inner(around);
    for (std::uint32_t j = 0; j < around; ++j) outer.push_back(at(top ? high : 0, j));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(top ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    for (std::uint32_t ring = 1; ring < kRings; ++ring) {
      for (std::uint32_t j = 0; j < around; ++j) {
        inner[j] = static_cast<std::uint32_t>(mesh.vertices.size());
        const double share = 1 - static_cast<double>(ring) / kRings;
        const Point& rim = mesh.vertices[at(top ? high : 0, j)];
        mesh.vertices.push_back({share * rim.x(), share * rim.y(), rim.z()});
      }
      for (std::uint32_t j = 0; j < around; ++j) {
        const std::uint32_t k = (j + 1) % around;
        add(outer[j], outer[k], inner[k]);
        add(outer[j], inner[k], inner[j]);
      }
      outer = inner;
    }
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({0, 0, top ? 1.0 : -1.0});
    for (std::uint32_t j = 0; j < around; ++j) add(outer[j], outer[(j + 1) % around], middle);
  }
  return mesh;
}

inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, const Point& by) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  for (const Point& p : b.vertices) a.vertices.push_back(p + by);
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return a;
}

inline TriangleMesh without_vertex(TriangleMesh mesh, std::uint32_t vertex) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::find(t.begin(), t.end(), vertex) != t.end();
  });
  return mesh;
}

}  // namespace emax::test
