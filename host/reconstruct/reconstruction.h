#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/registry.h"

namespace emax {

struct Reconstruction {
  TriangleMesh mesh;                // consistently oriented, outward as far as the cloud tells
  std::size_t unmeshed_points = 0;  // gp3: points that no vertex coincides with; 0 otherwise
};

// A surface from points (paper, section 2.1) by a method of the registry. A pure function of its
// arguments: equal input gives equal bytes, for any number of threads.
//
// The libraries calculate in binary32, so the cloud is moved to its bounding box's midpoint and
// scaled first; results come back in the cloud's own coordinates. Points that coincide after that
// rounding count as one.
//
// `values` holds every parameter of the method; others are ignored. Throws Error when there is no
// such method, when there are fewer than three distinct points, or when no triangle comes out. A
// method of single use (MethodDescription) runs at most once in a process.
Reconstruction reconstruct(std::string_view method, std::span<const Point> points,
                           const ParameterValues& values, std::size_t threads = 1);

// What runs a method.
struct MethodRun {
  std::string_view name;
  Reconstruction (*run)(const LocalCloud& cloud, const ParameterValues& values,
                        std::size_t threads);
};

template <typename... Method>
std::vector<MethodRun> runs_of(TypeList<Method...>) {
  return {{Method::kName, &Method::run}...};
}

// Of reconstruction_methods().
std::span<const MethodRun> method_runs();

}  // namespace emax
