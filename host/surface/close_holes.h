#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// How well triangles close a hole: first the cosine of the sharpest fold between them and with the
// mesh around, to be great, then their area, to be small.
struct PatchQuality {
  double fold = 1;
  double area = 0;

  bool operator==(const PatchQuality&) const = default;
  bool better_than(const PatchQuality& other) const {
    return fold != other.fold ? fold > other.fold : area < other.area;
  }
};

struct HolePatch {
  std::vector<std::array<std::size_t, 3>> triangles;  // of positions along the hole
  PatchQuality quality;
};

// A triangulation of the polygon `hole` whose sharpest fold is the least there is, up to
// kExactCorners corners, else nearly, and of little area (after Barequet and Sharir 1995 and Liepa
// 2003). `behind` holds, for the edge from each
// corner to the next, the third corner of the mesh's triangle on its other side; `may_join(i, j)`
// says whether two corners that are not neighbours may be joined. Triangles follow the polygon's
// direction. Nothing where there is no triangulation without triangles of no area, or none is
// found. O(k^4) time and O(k^3) memory for k corners where it is exact, else O(k^3) and O(k^2).
inline constexpr std::size_t kExactCorners = 60;
std::optional<HolePatch> best_patch(std::span<const Point> hole, std::span<const Point> behind,
                                    const std::function<bool(std::size_t, std::size_t)>& may_join);

struct ClosedHoles {
  TriangleMesh mesh;
  std::size_t closed = 0;   // holes
  std::size_t dropped = 0;  // triangles around them
};

// Closes holes of `mesh`, which is as manifold_part() gives it, without new vertices. Where a
// hole's rim folds over itself, so that no patch would continue it, up to kRimRings rings of
// triangles around it are dropped first, if the wider hole can be closed. A hole stays open when it
// has more than `most_edges` edges or is wider than `size`: when a vertex is farther than that many
// widths of the mesh from their mean. It also stays open when it is no crack (find_cracks()).
// What comes out is as manifold_part() gives it. O(n log n).
inline constexpr std::size_t kMostHoleEdges = 400;
inline constexpr int kRimRings = 4;
ClosedHoles close_holes(TriangleMesh mesh, double size,
                        double crack = std::numeric_limits<double>::infinity(),
                        std::size_t most_edges = kMostHoleEdges);

// close_holes() for all that can be closed, and what cannot. Holes of kMostClosedEdges edges take
// seconds.
struct OpenBorder {
  std::size_t edges = 0;
  Point middle;       // mean of its vertices
  double radius = 0;  // their greatest distance from it
};
struct ClosedSurface {
  TriangleMesh mesh;
  std::size_t closed = 0;        // holes
  std::vector<OpenBorder> open;  // borders that are left
};
inline constexpr std::size_t kMostClosedEdges = 1500;
ClosedSurface close_surface(TriangleMesh mesh);

// Border loops that are cracks (find_cracks()). For a mesh as manifold_part() gives it.
std::size_t count_cracks(const TriangleMesh& mesh, double crack);

}  // namespace emax
