// Brute force for every count of check_mesh: all pairs of triangles, clipped against each other in
// rational arithmetic, and topology by the definitions.

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <map>
#include <set>

#include "grid_point.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/triangle_mesh.h"

namespace emax::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Vector = std::array<Rational, 3>;

Vector exact(const Point& p) { return {Rational(p[0]), Rational(p[1]), Rational(p[2])}; }

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// The part of a convex polygon (or segment, or point) where normal . (p - origin) >= 0.
std::vector<Vector> clipped(const std::vector<Vector>& polygon, const Vector& origin,
                            const Vector& normal) {
  std::vector<Vector> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector& p = polygon[i];
    const Vector& q = polygon[(i + 1) % polygon.size()];
    const Rational hp = dot(normal, minus(p, origin));
    const Rational hq = dot(normal, minus(q, origin));
    if (hp >= 0) inside.push_back(p);
    if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) {
      const Rational t = hp / (hp - hq);
      const Vector along = minus(q, p);
      inside.push_back({p[0] + t * along[0], p[1] + t * along[1], p[2] + t * along[2]});
    }
  }
  return inside;
}

// Corners of the convex set that two triangles have in common.
std::vector<Vector> common(const std::array<Vector, 3>& a, const std::array<Vector, 3>& b) {
  const Vector normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
  const Vector opposite{-normal[0], -normal[1], -normal[2]};
  std::vector<Vector> polygon(a.begin(), a.end());
  polygon = clipped(clipped(polygon, b[0], normal), b[0], opposite);
  for (std::size_t i = 0; i < 3; ++i) {
    polygon = clipped(polygon, b[i], cross(normal, minus(b[(i + 1) % 3], b[i])));
  }
  return polygon;
}

bool on_segment(const Vector& p, const Vector& a, const Vector& b) {
  return is_zero(cross(minus(b, a), minus(p, a))) && dot(minus(p, a), minus(p, b)) <= 0;
}

bool twin_intersects(const TriangleMesh& mesh, const Triangle& s, const Triangle& t) {
  std::vector<Vector> shared;
  std::array<Vector, 3> a, b;
  for (std::size_t i = 0; i < 3; ++i) {
    a[i] = exact(mesh.vertices[s[i]]);
    b[i] = exact(mesh.vertices[t[i]]);
    if (std::count(t.begin(), t.end(), s[i]) != 0) shared.push_back(a[i]);
  }
  if (shared.size() == 3) return true;
  for (const Vector& p : common(a, b)) {
    const bool expected = !shared.empty() && on_segment(p, shared.front(), shared.back());
    if (!expected) return true;
  }
  return false;
}

bool twin_degenerate(const TriangleMesh& mesh, const Triangle& t) {
  const Vector a = exact(mesh.vertices[t[0]]);
  return is_zero(cross(minus(exact(mesh.vertices[t[1]]), a), minus(exact(mesh.vertices[t[2]]), a)));
}

bool repeats_index(const Triangle& t) {
  return std::set<std::uint32_t>(t.begin(), t.end()).size() < 3;
}

std::size_t shared_corners(const Triangle& s, const Triangle& t) {
  return static_cast<std::size_t>(std::count_if(
      s.begin(), s.end(), [&](std::uint32_t v) { return std::count(t.begin(), t.end(), v) != 0; }));
}

// Number of groups into which `count` items fall when related ones are joined.
template <class Related>
std::size_t groups(std::size_t count, const Related& related) {
  std::vector<std::size_t> group(count);
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) group[i] = i;
  for (std::size_t round = 0; round < count; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (related(i, j)) group[i] = group[j] = std::min(group[i], group[j]);
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) found += group[i] == i;
  return found;
}

MeshValidity twin(const TriangleMesh& mesh) {
  MeshValidity v;
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.triangles) {
    if (!repeats_index(t)) kept.push_back(t);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> directed;
  for (const Triangle& t : kept) {
    for (std::size_t i = 0; i < 3; ++i) ++directed[{t[i], t[(i + 1) % 3]}];
  }
  for (std::uint32_t a = 0; a < mesh.vertices.size(); ++a) {
    for (std::uint32_t b = a + 1; b < mesh.vertices.size(); ++b) {
      const auto uses = [&](std::uint32_t p, std::uint32_t q) {
        const auto found = directed.find({p, q});
        return found == directed.end() ? 0 : found->second;
      };
      const std::size_t up = uses(a, b), down = uses(b, a);
      v.boundary_edges += up + down == 1;
      v.non_manifold_edges += up + down > 2;
      v.inconsistent_edges += up + down == 2 && up != down;
    }
    std::vector<Triangle> star;
    for (const Triangle& t : kept) {
      if (std::count(t.begin(), t.end(), a) != 0) star.push_back(t);
    }
    v.non_manifold_vertices += groups(star.size(), [&](std::size_t i, std::size_t j) {
                                 return shared_corners(star[i], star[j]) >= 2;
                               }) > 1;
  }
  v.components = groups(kept.size(), [&](std::size_t i, std::size_t j) {
    return shared_corners(kept[i], kept[j]) >= 2;
  });
  std::set<std::size_t> involved;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (twin_degenerate(mesh, mesh.triangles[i])) {
      ++v.degenerate_triangles;
      continue;
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (twin_degenerate(mesh, mesh.triangles[j]) ||
          !twin_intersects(mesh, mesh.triangles[i], mesh.triangles[j])) {
        continue;
      }
      ++v.self_intersections;
      involved.insert({i, j});
    }
  }
  v.self_intersecting_triangles = involved.size();
  return v;
}

void expect_equal(const MeshValidity& a, const MeshValidity& b) {
  EXPECT_EQ(a.boundary_edges, b.boundary_edges);
  EXPECT_EQ(a.non_manifold_edges, b.non_manifold_edges);
  EXPECT_EQ(a.non_manifold_vertices, b.non_manifold_vertices);
  EXPECT_EQ(a.inconsistent_edges, b.inconsistent_edges);
  EXPECT_EQ(a.degenerate_triangles, b.degenerate_triangles);
  EXPECT_EQ(a.self_intersections, b.self_intersections);
  EXPECT_EQ(a.self_intersecting_triangles, b.self_intersecting_triangles);
  EXPECT_EQ(a.components, b.components);
}

// Random triangles over few vertices: on grids most pairs touch, are coplanar or share corners.
TEST(MeshValidityTwin, RandomTrianglesOnGridsAndOffThem) {
  std::array<std::array<std::size_t, 2>, 3> seen{};  // pairs by shared corners and intersection
  MeshValidity sum;
  for (std::uint64_t seed = 1; seed <= 160; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::uint32_t grid = 2 + seed % 4;
    const bool flat = seed % 8 == 3;
    const double offset = seed % 3 == 0 ? 1e7 : 0;
    // A grid of whole numbers, of tenths (rounded), or no grid.
    const double scale = seed % 5 == 0 ? 0.1 : 1;
    TriangleMesh mesh;
    for (int i = 0; i < 10; ++i) {
      Point p = grid_point(random, grid);
      if (flat) p[2] = 1;
      if (seed % 7 == 0) p = random.point(0, 1);
      mesh.vertices.push_back(scale * p + Point::Constant(offset));
    }
    for (int i = 0; i < 12; ++i) {
      const auto vertex = [&] { return random.below(10); };
      const std::uint32_t a = vertex(), b = vertex(), c = vertex();
      mesh.triangles.push_back({a, b, c});
    }
    const MeshValidity expected = twin(mesh);
    const MeshValidity found = check_mesh(mesh.view());
    expect_equal(found, expected);
    for (const Triangle& s : mesh.triangles) {
      for (const Triangle& t : mesh.triangles) {
        if (&s >= &t || twin_degenerate(mesh, s) || twin_degenerate(mesh, t)) continue;
        const std::size_t shared = shared_corners(s, t);
        if (shared < 3) ++seen[shared][twin_intersects(mesh, s, t)];
      }
    }
    sum.boundary_edges += expected.boundary_edges;
    sum.non_manifold_edges += expected.non_manifold_edges;
    sum.non_manifold_vertices += expected.non_manifold_vertices;
    sum.inconsistent_edges += expected.inconsistent_edges;
    sum.degenerate_triangles += expected.degenerate_triangles;
  }
  for (const auto& by_answer : seen) {
    EXPECT_GT(by_answer[0], 100u);
    EXPECT_GT(by_answer[1], 100u);
  }
  EXPECT_GT(sum.boundary_edges, 100u);
  EXPECT_GT(sum.non_manifold_edges, 100u);
  EXPECT_GT(sum.non_manifold_vertices, 100u);
  EXPECT_GT(sum.inconsistent_edges, 100u);
  EXPECT_GT(sum.degenerate_triangles, 100u);
}

// A surface whose vertices are moved until it folds through itself.
TEST(MeshValidityTwin, CrumpledSurface) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const Stimulus sphere = bumpy_sphere(6, 7, 0, kSeed);
  TriangleMesh mesh{sphere.vertices, sphere.triangles};
  Random random(kSeed);
  for (Point& p : mesh.vertices) p += 0.5 * random.point(-1, 1);
  const MeshValidity found = check_mesh(mesh.view());
  EXPECT_GT(found.self_intersections, 10u);
  expect_equal(found, twin(mesh));
}

}  // namespace
}  // namespace emax::test
