#pragma once

#include <functional>
#include <optional>
#include <span>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_topology.h"
#include "host/surface/close_holes.h"

namespace emax {

// The mesh that `decimate` was given, as the reference that its results are held to.
struct GivenReference {
  ReferenceSurface surface;
  std::optional<MeshTopology> before_repair;  // where that was asked for
  std::optional<ClosedSurface> closed;        // likewise

  // The surface is the mesh as it was given, but for its order.
  bool is_as_given() const;
  // No hole is left that was to be closed.
  bool all_closed() const { return !closed || closed->open.empty(); }
};

struct ReferenceWishes {
  bool repair = false;  // what intersects or is not manifold is removed instead of cut apart
  bool closed = false;  // every hole is closed
};

// `kept`: points that become vertices of the reference where they are farther than `far` from it.
// Throws Error as reference_surface() does.
GivenReference make_reference(const TriangleMesh& given, std::span<const Point> kept, double far,
                              const ReferenceWishes& wishes,
                              const std::function<bool()>& interrupted);

// What was done to the mesh. `file`: where the reference is to be found; empty of a one-sided
// bound.
void print(const GivenReference& reference, const std::string& file);

}  // namespace emax
