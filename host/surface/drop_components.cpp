#include "host/surface/drop_components.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/surface/mesh_orientation.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {
namespace {

constexpr double kAlikeAreas =
    8;  // components within this ratio of areas are tested in the same round

class Components {
 public:
  explicit Components(const TriangleMesh& mesh)
      : mesh_(mesh), sets_(mesh.vertices.size()), areas_(mesh.vertices.size(), 0) {
    for (const Triangle& t : mesh.triangles) {
      sets_.join(t[0], t[1]);
      sets_.join(t[1], t[2]);
    }
    for (const Triangle& t : mesh.triangles) {
      const Point &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      areas_[of(t)] += 0.5 * (b - a).cross(c - a).norm();
    }
  }

  std::size_t of(const Triangle& t) { return sets_.root(t[0]); }
  double area(std::size_t component) const { return areas_[component]; }
  std::size_t largest() const {
    return static_cast<std::size_t>(std::ranges::max_element(areas_) - areas_.begin());
  }

  TriangleMesh part(const std::vector<bool>& chosen) {
    TriangleMesh part = mesh_;
    std::erase_if(part.triangles, [&](const Triangle& t) { return !chosen[of(t)]; });
    return part;
  }

 private:
  const TriangleMesh& mesh_;
  DisjointSets sets_;
  std::vector<double> areas_;  // of each component, at its root
};

}  // namespace

TriangleMesh drop_needless_components(TriangleMesh mesh, std::span<const Point> cloud, double far) {
  Components components(mesh);
  std::vector<bool> kept(mesh.vertices.size(), false), added = kept;
  added[components.largest()] = true;
  TriangleMesh part = components.part(added);
  if (part.triangles.size() == mesh.triangles.size()) return mesh;

  struct Open {  // a point that is not yet known to be near a kept component
    Point point;
    std::size_t component;  // nearest to it
  };
  std::vector<Open> open;
  const ExactMesh all(mesh.view());
  for (const Point& p : cloud) {
    open.push_back({p, components.of(mesh.triangles[all.nearest(p).triangle])});
  }
  for (;;) {
    const ExactMesh near(part.view());
    std::erase_if(open, [&](const Open& o) {
      return added[o.component] || near.nearest(o.point, far).distance.upper <= far;
    });
    for (std::size_t c = 0; c < kept.size(); ++c) kept[c] = kept[c] || added[c];
    if (open.empty()) break;
    double greatest = 0;
    for (const Open& o : open) greatest = std::max(greatest, components.area(o.component));
    added.assign(added.size(), false);
    for (const Open& o : open) {
      if (components.area(o.component) >= greatest / kAlikeAreas) added[o.component] = true;
    }
    part = components.part(added);
  }
  mesh = components.part(kept);
  drop_unused(mesh);
  return mesh;
}

}  // namespace emax
