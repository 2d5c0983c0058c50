#pragma once

#include <cstddef>
#include <string>

#include "sw_model/base/mesh_view.h"

namespace emax {

// What a surface is like however it is bent: of how many pieces it is, how many closed lines bound
// it, and how many handles its pieces have together.
//
// Any mesh is understood as the surface it becomes when it is cut apart along every edge that is
// not of exactly two triangles which run through it in opposite directions, and at every vertex
// whose triangles are more than one fan after that. So a cut along an edge of three triangles is
// border three times. Edges and vertices are told apart by index, not position. The surface left by
// the cuts is manifold and oriented: a one-sided surface, such as a Moebius strip, counts as it is
// after the cut along the edges where its triangles disagree. Triangles with a repeated index and
// vertices of no triangle are no part of it.
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
