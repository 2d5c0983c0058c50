#pragma once

#include <limits>

#include "sw_model/base/mesh_view.h"
#include "sw_model/model/normalization.h"

namespace emax {

// What the kernel's error depends on of a mesh (docs/numerics.md), in the cloud's unit. That of the
// whole is that of its parts, joined in any order.
struct MeshExtent {
  Point lower = Point::Constant(std::numeric_limits<double>::infinity());
  Point upper = -lower;  // the box of its corners
  double longest_edge = 0;
  double farthest = 0;  // of a corner from the normalization's origin

  MeshExtent() = default;  // of no triangle
  // O(n).
  MeshExtent(MeshView mesh, const Normalization& normalization);
  void join(const MeshExtent& other);
  bool operator==(const MeshExtent&) const = default;
};

}  // namespace emax
