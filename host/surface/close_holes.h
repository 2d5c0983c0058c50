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

// How well triangles close a hole. `fold` is the cosine of the sharpest fold between them and with
// the mesh around; greater is better. It is compared first. `area` is their area; smaller is
// better.
struct PatchQuality {
  double fold = 1;
  double area = 0;

  bool operator==(const PatchQuality&) const = default;
  bool better_than(const PatchQuality& other) const {
    return fold != other.fold ? fold > other.fold : area < other.area;
  }
};

struct HolePatch {
  std::vector<std::array<std::size_t, 3>> triangles;  // indices of corners of the hole
  PatchQuality quality;
};

// Triangulates the polygon `hole` (after Barequet and Sharir 1995 and Liepa 2003). Up to
// kExactCorners corners the sharpest fold is the least possible, else nearly so; the area is small.
// `behind` holds, for the edge from each corner to the next, the third corner of the mesh's
// triangle on its other side. `may_join(i, j)` tells whether two corners that are not neighbours
// may be joined. Triangles follow the polygon's direction. Returns nothing where every
// triangulation has a triangle of no area, or none is found. For k corners: O(k^4) time and O(k^3)
// memory up to kExactCorners, else O(k^3) and O(k^2).
inline constexpr std::size_t kExactCorners = 60;
std::optional<HolePatch> best_patch(std::span<const Point> hole, std::span<const Point> behind,
                                    const std::function<bool(std::size_t, std::size_t)>& may_join);

struct ClosedHoles {
  TriangleMesh mesh;
  std::size_t closed = 0;   // holes
  std::size_t dropped = 0;  // triangles around them
};

// Closes holes of `mesh` without new vertices. Where a hole's rim folds over itself, no patch can
// continue it; then up to kRimRings rings of triangles around it are dropped first, if the wider
// hole can be closed. A hole stays open if it has more than `most_edges` edges, if a vertex of it
// is farther from their mean than `size` times the mesh's width, or if it is not a crack
// (find_cracks()). `mesh` is as manifold_part() gives it; so is the result. O(n log n).
inline constexpr std::size_t kMostHoleEdges = 400;
inline constexpr int kRimRings = 4;
ClosedHoles close_holes(TriangleMesh mesh, double size,
                        double crack = std::numeric_limits<double>::infinity(),
                        std::size_t most_edges = kMostHoleEdges);

// A border loop: its vertices in the direction of the triangles that would close it, and the
// triangle of the mesh at the edge from each to the next.
struct HoleRim {
  std::vector<std::uint32_t> vertices;
  std::vector<Triangle> triangles;
};

struct HoleChoice {
  std::function<bool(const HoleRim&)> may_close;
  // `patch` closes the hole, and those that became one with it when `dropped` were.
  std::function<bool(const HoleRim&, std::span<const Triangle> patch,
                     std::span<const Triangle> dropped)>
      permits;
};

// Closes holes as close_holes() does, but those that may be closed, by patches that are permitted.
// The border loops around a surface from outside are among those asked for. No triangle of a patch
// is dropped again. Vertices stay, also those without triangles; the triangles that are left of the
// mesh keep their order, those of patches follow. `mesh` is as cut_to_manifold() gives it; so is
// the result, with no intersections that were not there. O(n log n) and best_patch().
ClosedHoles close_chosen_holes(TriangleMesh mesh, const HoleChoice& choice,
                               std::size_t most_edges = kMostHoleEdges);

// close_holes() for all holes that can be closed, with a list of the borders that stay open. Holes
// of kMostClosedEdges edges take seconds.
struct OpenBorder {
  std::size_t edges = 0;
  Point middle;       // mean of its vertices
  double radius = 0;  // their greatest distance from the mean
};
struct ClosedSurface {
  TriangleMesh mesh;
  std::size_t closed = 0;        // holes
  std::vector<OpenBorder> open;  // borders that stay open
};
inline constexpr std::size_t kMostClosedEdges = 1500;
ClosedSurface close_surface(TriangleMesh mesh);

// Number of border loops that are cracks (find_cracks()). `mesh` is as manifold_part() gives it.
std::size_t count_cracks(const TriangleMesh& mesh, double crack);

}  // namespace emax
