#include "tests/benchmarks/cgal_peer.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

#include <algorithm>
#include <vector>

namespace emax::benchmarks {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 cgal_point(const Point& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct CgalPeer::Data {
  std::vector<Kernel::Point_3> cloud;
  Triangles triangles;
  std::unique_ptr<Tree> tree;
  Mode mode = Mode::kKdTree;
};

CgalPeer::CgalPeer(std::span<const Point> cloud, std::span<const std::uint32_t> order,
                   MeshView mesh)
    : data_(std::make_unique<Data>()) {
  for (const std::uint32_t i : order) data_->cloud.push_back(cgal_point(cloud[i]));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.corners(i);
    data_->triangles.emplace_back(cgal_point(a), cgal_point(b), cgal_point(c));
  }
}

CgalPeer::~CgalPeer() = default;

void CgalPeer::build(Mode mode) {
  data_->mode = mode;
  data_->tree = std::make_unique<Tree>(data_->triangles.cbegin(), data_->triangles.cend());
  data_->tree->do_not_accelerate_distance_queries();
  data_->tree->build();
  if (mode == Mode::kKdTree) data_->tree->accelerate_distance_queries();
}

double CgalPeer::greatest_squared_distance() const {
  double greatest = 0;
  const Tree& tree = *data_->tree;
  Kernel::Point_3 nearest = data_->triangles.front()[0];
  for (const Kernel::Point_3& p : data_->cloud) {
    nearest = data_->mode == Mode::kKdTree ? tree.closest_point(p) : tree.closest_point(p, nearest);
    greatest = std::max(greatest, CGAL::squared_distance(p, nearest));
  }
  return greatest;
}

std::string CgalPeer::version() { return CGAL_VERSION_STR; }

}  // namespace emax::benchmarks
