#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter_spec.h"

namespace emax {

struct Reconstruction {
  TriangleMesh mesh;                // consistently oriented, outward as far as the cloud tells
  std::size_t unmeshed_points = 0;  // gp3: points that no vertex coincides with; 0 otherwise
};

// A surface from points (paper, section 2.1). A pure function of its arguments: equal input gives
// equal bytes.
//
// The libraries calculate in binary32, so the cloud is moved to its bounding box's midpoint and
// scaled first; results come back in the cloud's own coordinates. Points that coincide after that
// rounding count as one.
class ReconstructionMethod {
 public:
  virtual ~ReconstructionMethod() = default;
  virtual std::string_view name() const = 0;
  std::span<const ParameterSpec> parameters() const;

  // `values` holds every parameter of parameters(); others are ignored.
  // Throws Error when there are fewer than three distinct points, or when no triangle comes out.
  // A method of single_use() runs at most once in a process.
  Reconstruction reconstruct(std::span<const Point> points, const ParameterValues& values) const;

 private:
  virtual Reconstruction run(const class LocalCloud& cloud,
                             const ParameterValues& values) const = 0;
};

// Throws Error when there is no such method.
const ReconstructionMethod& reconstruction_method(std::string_view name);

}  // namespace emax
