#include "tests/benchmarks/features/nearest_triangles.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>

namespace emax::benchmarks {
namespace {

using Cartesian = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Cartesian::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Cartesian, Triangles::const_iterator>;

}  // namespace

std::vector<NearestTriangle> nearest_triangles(std::span<const Point> points, MeshView mesh) {
  const auto to_cgal = [](const Point& p) { return Cartesian::Point_3(p.x(), p.y(), p.z()); };
  Triangles triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.corners(i);
    triangles.emplace_back(to_cgal(a), to_cgal(b), to_cgal(c));
  }
  CGAL::AABB_tree<CGAL::AABB_traits<Cartesian, Primitive>> tree(triangles.cbegin(),
                                                                triangles.cend());
  std::vector<NearestTriangle> found;
  for (const Point& p : points) {
    const auto [nearest, primitive] = tree.closest_point_and_primitive(to_cgal(p));
    found.push_back({static_cast<std::uint32_t>(primitive - triangles.cbegin()),
                     std::sqrt(CGAL::squared_distance(to_cgal(p), nearest))});
  }
  return found;
}

}  // namespace emax::benchmarks
