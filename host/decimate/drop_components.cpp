#include "host/decimate/drop_components.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/reconstruct/mesh_orientation.h"
#include "sw_model/exact_distance.h"

namespace emax {

TriangleMesh drop_needless_components(TriangleMesh mesh, std::span<const Point> cloud, double far) {
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  std::vector<double> areas(mesh.vertices.size(), 0);  // at the components' roots
  for (const Triangle& t : mesh.triangles) {
    const Point &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    areas[sets.root(t[0])] += 0.5 * (b - a).cross(c - a).norm();
  }
  const auto main = static_cast<std::size_t>(std::ranges::max_element(areas) - areas.begin());
  TriangleMesh rest = mesh;
  std::erase_if(rest.triangles, [&](const Triangle& t) { return sets.root(t[0]) != main; });
  if (rest.triangles.size() == mesh.triangles.size()) return mesh;

  const ExactMesh all(mesh.view()), largest(rest.view());
  std::vector<bool> needed(mesh.vertices.size(), false);
  needed[main] = true;
  for (const Point& p : cloud) {
    const std::uint32_t nearest = all.nearest(p).triangle;
    const std::size_t component = sets.root(mesh.triangles[nearest][0]);
    if (needed[component]) continue;
    needed[component] = largest.nearest(p, far).distance.upper > far;
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return !needed[sets.root(t[0])]; });
  drop_unused(mesh);
  return mesh;
}

}  // namespace emax
