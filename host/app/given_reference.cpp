#include "host/app/given_reference.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "host/app/fit_report.h"
#include "host/app/scan.h"
#include "host/surface/manifold_part.h"

namespace emax {
namespace {

constexpr double kAnyHole = 1;  // as wide as the mesh

TriangleMesh closed_on_planes(TriangleMesh mesh, const ReferenceWishes& wishes,
                              GivenReference& made) {
  if (wishes.planes == nullptr) return mesh;
  made.on_planes = close_on_planes(mesh, *wishes.planes,
                                   {wishes.plane_epsilon, wishes.plane_farthest, wishes.threads});
  return std::exchange(made.on_planes->mesh, {});
}

// Makes the surface by cutting the mesh apart where it is not manifold, then closes it.
void close_by_cutting(const TriangleMesh& given, std::span<const Point> kept,
                      const JoiningDistance& far, const ReferenceWishes& wishes,
                      const std::function<bool()>& interrupted, GivenReference& made) {
  CutSurface cut = cut_to_manifold(given);
  TriangleMesh mesh = std::move(cut.mesh);
  if (wishes.closed) {
    made.closed = close_surface(std::move(mesh));
    mesh = made.closed->mesh;
  } else {
    mesh = closed_on_planes(std::move(mesh), wishes, made);
  }
  ReferenceSurface& surface = made.surface;
  surface =
      reference_surface(mesh, kept, far, interrupted, MadeManifold::kByCutting, wishes.threads);
  surface.merged += cut.merged;
  surface.turned += cut.turned;
  surface.dropped += cut.dropped;
  surface.split += cut.split;
  surface.cut_edges += cut.cut_edges;
  surface.cut_vertices += cut.cut_vertices;
}

void repair(const TriangleMesh& given, std::span<const Point> kept, const JoiningDistance& far,
            const ReferenceWishes& wishes, const std::function<bool()>& interrupted,
            GivenReference& made) {
  made.before_repair = topology_of(cut_to_manifold(given).mesh.view());
  ManifoldPart part = manifold_part(given);
  if (made.before_repair->border_loops == 0 && !part.mesh.triangles.empty()) {
    ClosedHoles closed = close_holes(std::move(part.mesh), kAnyHole);
    part.mesh = std::move(closed.mesh);
    part.dropped += closed.dropped;
  }
  if (wishes.closed) {
    made.closed = close_surface(std::move(part.mesh));
    part.mesh = made.closed->mesh;
  } else {
    part.mesh = closed_on_planes(std::move(part.mesh), wishes, made);
  }
  made.surface = reference_surface(part.mesh, kept, far, interrupted, MadeManifold::kByDropping,
                                   wishes.threads);
  made.surface.dropped += part.dropped;
}

}  // namespace

bool GivenReference::is_as_given() const {
  const ReferenceSurface& s = surface;
  return !before_repair && !closed && (!on_planes || on_planes->on_planes + on_planes->own == 0) &&
         s.merged == 0 && s.turned == 0 && s.dropped == 0 && s.split == 0 && s.cut_vertices == 0 &&
         s.inserted == 0;
}

GivenReference make_reference(const TriangleMesh& given, std::span<const Point> kept,
                              const JoiningDistance& far, const ReferenceWishes& wishes,
                              const std::function<bool()>& interrupted) {
  GivenReference made;
  if (wishes.repair) {
    repair(given, kept, far, wishes, interrupted, made);
  } else if (wishes.closed || wishes.planes != nullptr) {
    close_by_cutting(given, kept, far, wishes, interrupted, made);
  } else {
    made.surface =
        reference_surface(given, kept, far, interrupted, MadeManifold::kByCutting, wishes.threads);
  }
  return made;
}

void print(Facts& facts, const GivenReference& reference, const std::string& file) {
  if (reference.on_planes) print_on_planes(facts, *reference.on_planes);
  if (reference.is_as_given()) return;
  const ReferenceSurface& s = reference.surface;
  std::string made;
  const auto say = [&](std::size_t count, std::string_view what, std::string_view then) {
    if (count == 0) return;
    made += fmt::format("{}{} {} {}", made.empty() ? "" : ", ", grouped(count), what, then);
  };
  say(s.merged, s.merged == 1 ? "vertex" : "vertices", "merged with others at the same place");
  say(s.turned, s.turned == 1 ? "triangle" : "triangles", "turned to agree with the others");
  say(s.dropped, s.dropped == 1 ? "triangle" : "triangles",
      reference.before_repair ? "removed (degenerate, not manifold or intersecting others)"
                              : "removed (degenerate or repeated)");
  say(s.split, s.split == 1 ? "triangle" : "triangles", "split at vertices on their sides");
  say(s.cut_edges, s.cut_edges == 1 ? "non-manifold edge" : "non-manifold edges", "cut apart");
  say(s.cut_vertices, s.cut_vertices == 1 ? "non-manifold vertex" : "non-manifold vertices",
      "cut apart");
  say(s.inserted, s.inserted == 1 ? "point" : "points", "added that the mesh missed");
  const std::size_t holes =
      reference.on_planes ? reference.on_planes->on_planes + reference.on_planes->own : 0;
  say(holes, holes == 1 ? "flat hole" : "flat holes", "closed");
  facts.add("reference", "{}{}", made.empty() ? "as given" : made, file.empty() ? "" : ": " + file);
  if (reference.closed) print_closed(facts, reference.closed->closed, reference.closed->open);
  if (!reference.before_repair) return;
  const bool was_closed = reference.before_repair->border_loops == 0;
  const MeshTopology now = topology_of(s.mesh.view());
  facts.add("repaired", "{}{}; now {}", describe(*reference.before_repair),
            was_closed && now.border_loops > 0 ? "; was closed, now open" : "", describe(now));
}

}  // namespace emax
