#include "host/surface/crack_free.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "host/geometry/mesh_topology.h"
#include "host/surface/close_holes.h"
#include "host/surface/drop_components.h"
#include "host/surface/edge_flips.h"
#include "host/surface/manifold_part.h"

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

}  // namespace

CrackFreeSurface crack_free_surface(TriangleMesh mesh, std::span<const Point> cloud, double far,
                                    double size, double crack, bool interpolates) {
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
  if (interpolates) flip_edges(surface.mesh);
  return surface;
}

}  // namespace emax
