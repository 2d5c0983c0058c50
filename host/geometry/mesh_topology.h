#pragma once

#include <cstddef>
#include <string>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Properties of a surface that do not depend on how it is bent: the number of its pieces, of the
// closed lines that bound it, and of the handles of all pieces together. Any mesh is understood as
// the surface that these cuts make of it: along every edge that is not of exactly two triangles
// which run through it in opposite directions, then at every vertex whose triangles form more than
// one fan. An edge of three triangles therefore becomes border three times. Edges and vertices are
// distinguished by index, not by position. The surface after the cuts is manifold and oriented. A
// one-sided surface, such as a Moebius strip, is counted after the cut along the edges where its
// triangles disagree. Triangles with a repeated index and vertices of no triangle do not count.
//
// Genus is the sum over the components: (2 components - border loops - characteristic) / 2 with the
// Euler characteristic vertices - edges + triangles of the cut surface.
struct MeshTopology {
  std::size_t components = 0;
  std::size_t border_loops = 0;
  std::size_t genus = 0;

  bool operator==(const MeshTopology&) const = default;
};

// Indices are in range. Near linear in the triangles.
MeshTopology topology_of(const MeshView& mesh);

// "1 component, 5 borders, genus 0"; "closed" for no borders.
std::string describe(const MeshTopology& topology);

}  // namespace emax
