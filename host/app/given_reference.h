#pragma once

#include <functional>
#include <optional>
#include <span>

#include "host/app/facts.h"
#include "host/decimate/bounded_decimation.h"
#include "host/decimate/close_on_planes.h"
#include "host/decimate/joining_distance.h"
#include "host/geometry/mesh_topology.h"
#include "host/surface/close_holes.h"

namespace emax {

// The mesh that `decimate` was given, as the reference of its results.
struct GivenReference {
  ReferenceSurface surface;
  std::optional<MeshTopology> before_repair;  // if `repair` was asked for
  std::optional<ClosedSurface> closed;        // if `closed` was asked for
  std::optional<ClosedOnPlanes> on_planes;    // without its mesh, if `planes` were given

  // Whether the surface is the given mesh except for the order of its parts.
  bool is_as_given() const;
  // Whether all holes that were to be closed are closed.
  bool all_closed() const { return !closed || closed->open.empty(); }
};

struct ReferenceWishes {
  bool repair = false;  // remove parts that intersect or are not manifold instead of cutting
  bool closed = false;  // close every hole
  std::size_t threads = 1;
  // Holes on these are closed: close_on_planes(); with `closed` all are, anyway.
  const PlaneParts* planes = nullptr;
  double plane_epsilon = 0, plane_farthest = 0;
};

// `kept`: points that become vertices of the reference where `far` says so.
// Throws Error as reference_surface() does.
GivenReference make_reference(const TriangleMesh& given, std::span<const Point> kept,
                              const JoiningDistance& far, const ReferenceWishes& wishes,
                              const std::function<bool()>& interrupted);

// Prints the changes of the mesh. `file`: the path of the reference; empty for a one-sided bound.
void print(Facts& facts, const GivenReference& reference, const std::string& file);

}  // namespace emax
