#pragma once

#include <cstddef>
#include <span>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// A reconstruction as a surface without cracks, and the counts of the changes.
struct CrackFreeSurface {
  TriangleMesh mesh;                  // as manifold_part() gives it
  std::size_t dropped_triangles = 0;  // not manifold, without area or intersecting others
  std::size_t dropped_pieces = 0;     // components that no point needs
  double dropped_area = 0;            // of these pieces
  std::size_t closed_cracks = 0;
};

// Applies manifold_part(), then close_holes() with `size` and `crack`. drop_needless_components()
// with `far` runs before and after close_holes(), because pieces that no point needs would be in
// the way of the patches; with a `far` of 0 all pieces stay. If the mesh `interpolates` its points,
// flip_edges() follows: the method's choice of edges between the points is not significant.
CrackFreeSurface crack_free_surface(TriangleMesh mesh, std::span<const Point> cloud, double far,
                                    double size, double crack, bool interpolates);

}  // namespace emax
