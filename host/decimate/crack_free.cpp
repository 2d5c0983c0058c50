#include "host/decimate/crack_free.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <unordered_set>
#include <vector>

#include "host/decimate/close_holes.h"
#include "host/decimate/cracks.h"
#include "host/decimate/drop_components.h"
#include "host/decimate/manifold_part.h"
#include "host/geometry/mesh_topology.h"

namespace emax {
namespace {

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

void drop_needless(CrackFreeSurface& surface, std::span<const Point> cloud, double far) {
  if (!(far > 0)) return;
  const std::size_t pieces = topology_of(surface.mesh.view()).components;
  if (pieces <= 1) return;
  const double area = area_of(surface.mesh);
  surface.mesh = drop_needless_components(std::move(surface.mesh), cloud, far);
  surface.dropped_pieces += pieces - topology_of(surface.mesh.view()).components;
  surface.dropped_area += std::max(0.0, area - area_of(surface.mesh));
}

std::vector<std::vector<RimEdge>> loops_of(const TriangleMesh& mesh) {
  std::unordered_set<std::uint64_t> edges;
  const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.insert(key(t[k], t[(k + 1) % 3]));
  }
  std::map<std::uint32_t, Triangle> border;  // of a vertex: itself, the next and the third
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      if (!edges.contains(key(to, from))) border[from] = {from, to, t[(k + 2) % 3]};
    }
  }
  std::vector<std::vector<RimEdge>> loops;
  std::vector<bool> seen(mesh.vertices.size(), false);
  for (const auto& [start, first] : border) {
    std::vector<RimEdge> loop;
    for (std::uint32_t v = start; !seen[v]; v = border.at(v)[1]) {
      seen[v] = true;
      const auto& [from, to, behind] = border.at(v);
      loop.push_back({mesh.vertices[from], mesh.vertices[to], mesh.vertices[behind]});
    }
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

CrackFreeSurface crack_free_surface(TriangleMesh mesh, std::span<const Point> cloud, double far,
                                    double size, double crack) {
  ManifoldPart part = manifold_part(std::move(mesh));
  CrackFreeSurface surface;
  surface.mesh = std::move(part.mesh);
  surface.dropped_triangles = part.dropped;
  if (surface.mesh.triangles.empty()) return surface;
  drop_needless(surface, cloud, far);
  ClosedHoles closed = close_holes(std::move(surface.mesh), size, crack);
  surface.mesh = std::move(closed.mesh);
  surface.closed_cracks = closed.closed;
  drop_needless(surface, cloud, far);
  return surface;
}

std::size_t count_cracks(const TriangleMesh& mesh, double crack) {
  const std::vector<bool> cracks = find_cracks(loops_of(mesh), mesh.vertices, crack);
  return static_cast<std::size_t>(std::ranges::count(cracks, true));
}

}  // namespace emax
