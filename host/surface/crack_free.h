#pragma once

#include <cstddef>
#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// A reconstruction as a surface without cracks, and what was done to it.
struct CrackFreeSurface {
  TriangleMesh mesh;                  // as manifold_part() gives it
  std::size_t dropped_triangles = 0;  // not manifold, without area or intersecting others
  std::size_t dropped_pieces = 0;     // components that no point needs
  double dropped_area = 0;            // of these pieces
  std::size_t closed_cracks = 0;
};

// manifold_part(), close_holes() with `size` and `crack`, and before and after it
// drop_needless_components() with `far`, as pieces that no point needs would be in the patches'
// way; with a `far` of 0 all pieces stay. Then flip_edges(), where the mesh `interpolates`: which
// of its points a method has joined is of no account.
CrackFreeSurface crack_free_surface(TriangleMesh mesh, std::span<const Point> cloud, double far,
                                    double size, double crack, bool interpolates);

}  // namespace emax
