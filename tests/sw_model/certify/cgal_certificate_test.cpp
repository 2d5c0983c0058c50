// The certificate against CGAL's exact arithmetic: an axis-aligned box tree over rational numbers
// that shares no line with the oracle. Squares are compared, exactly, so no square root blurs it.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "sw_model/certify/certificate.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Exact::FT;
using ExactTriangles = std::vector<Exact::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Exact, ExactTriangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Exact, Primitive>>;

Exact::Point_3 exact(const Point& p) { return {p.x(), p.y(), p.z()}; }

Exact::Triangle_3 exact(const std::array<Point, 3>& corners) {
  return {exact(corners[0]), exact(corners[1]), exact(corners[2])};
}

bool at_least(double bound, const Number& squared) {
  return Number(bound) * Number(bound) >= squared;
}
bool at_most(double bound, const Number& squared) {
  return Number(bound) * Number(bound) <= squared;
}

// Both bounds hold, and the upper one is within a relative 1e-12 of the exact value and `absolute`.
bool certifies(const DistanceBounds& bounds, const Number& squared, double absolute) {
  return at_least(bounds.upper, squared) && at_most(bounds.lower, squared) &&
         at_most(std::max(bounds.upper * (1 - 1e-12) - absolute, 0.0), squared);
}

// The same mesh and cloud, seen by both; `size` is theirs. A point next to a triangle is known to
// roundings of the triangle's size, e_max to 1e-12 of itself.
void expect_agreement(const test::Stimulus& s, double size) {
  ExactTriangles triangles;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    triangles.push_back(exact(s.mesh().corners(t)));
  }
  const Tree tree(triangles.begin(), triangles.end());
  const ExactMesh oracle(s.mesh());
  Number greatest = 0;
  for (std::size_t i = 0; i < s.cloud.size(); ++i) {
    const Number squared = tree.squared_distance(exact(s.cloud[i]));
    ASSERT_TRUE(certifies(oracle.distance(s.cloud[i]), squared, 1e-14 * size)) << "point " << i;
    greatest = std::max(greatest, squared);
  }
  const CertifiedError certified = certify(s.cloud, s.mesh());
  EXPECT_TRUE(certifies({certified.e_max_lower, certified.e_max_upper}, greatest, 0));
  EXPECT_GT(CGAL::to_double(greatest), 0);
  const Number worst = tree.squared_distance(exact(s.cloud[certified.worst_point]));
  EXPECT_TRUE(certifies({certified.e_max_lower, certified.e_max_upper}, worst, 0));
}

test::Stimulus soup(std::uint64_t seed, std::size_t triangles, std::size_t points,
                    const std::function<Point(const Point&, const Point&, test::Random&)>& apex) {
  test::Random random(seed);
  test::Stimulus s{"soup", {}, {}, {}};
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1);
    s.vertices.insert(s.vertices.end(), {a, b, apex(a, b, random)});
    s.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (std::size_t i = 0; i < points; ++i) s.cloud.push_back(random.point(-1.5, 1.5));
  return s;
}

Point anywhere(const Point&, const Point&, test::Random& random) { return random.point(-1, 1); }

Point beside_the_edge(const Point& a, const Point& b, test::Random& random) {
  return a + random.uniform(0, 1) * (b - a) +
         std::pow(10.0, random.uniform(-12, -3)) * random.point(-1, 1);
}

TEST(CgalCertificate, AgreesOnARandomCloud) { expect_agreement(soup(91, 300, 300, anywhere), 1); }

TEST(CgalCertificate, AgreesOnSlivers) { expect_agreement(soup(92, 300, 300, beside_the_edge), 1); }

TEST(CgalCertificate, AgreesFarFromTheOriginWithMillimetreDetail) {
  test::Stimulus s = test::bumpy_sphere(12, 16, 300, 93);
  const Point origin(1e7, -2.5e7, 4e6);
  for (Point& p : s.vertices) p = origin + 1e-2 * p;
  for (Point& p : s.cloud) p = origin + 1.1e-2 * p;
  expect_agreement(s, 1e-2);
}

// Every eighth face and every fortieth vertex of the bunny, or of a sphere where it was not
// fetched.
TEST(CgalCertificate, AgreesOnASurface) {
  test::Stimulus all = test::bumpy_sphere(100, 200, 0, 94);
  if (std::ifstream file(EMAX_BUNNY); file) {
    std::string magic;
    std::size_t vertices = 0, faces = 0, edges = 0;
    file >> magic >> vertices >> faces >> edges;
    all = {"bunny", {}, std::vector<Point>(vertices), std::vector<Triangle>(faces)};
    for (Point& p : all.vertices) file >> p.x() >> p.y() >> p.z();
    for (Triangle& t : all.triangles) file >> edges >> t[0] >> t[1] >> t[2];
    ASSERT_TRUE(file) << EMAX_BUNNY;
  }
  SCOPED_TRACE(all.name);
  test::Stimulus s{all.name, {}, all.vertices, {}};
  test::Random random(95);
  for (std::size_t i = 0; i < all.triangles.size(); i += 8) s.triangles.push_back(all.triangles[i]);
  const double size = (all.vertices.front() - all.vertices.back()).norm();
  for (std::size_t i = 0; i < all.vertices.size(); i += 40) {
    s.cloud.push_back(all.vertices[i] + 0.01 * size * random.point(-1, 1));
  }
  expect_agreement(s, size);
}

// What the comparison must notice. Each fault is a plausible mistake in an oracle.
using Oracle = std::function<DistanceBounds(const Point&, const std::array<Point, 3>&)>;

int rejected(const Oracle& oracle, std::uint64_t seed) {
  test::Random random(seed);
  int count = 0;
  for (int i = 0; i < 300; ++i) {
    const Point a = random.point(-1, 1), b = random.point(-1, 1);
    const std::array<Point, 3> corners = {
        a, b, i % 2 == 0 ? random.point(-1, 1) : beside_the_edge(a, b, random)};
    const Point p = random.point(-3, 3);
    const Number squared = CGAL::squared_distance(exact(p), exact(corners));
    count += certifies(oracle(p, corners), squared, 1e-14) ? 0 : 1;
  }
  return count;
}

TEST(CgalCertificate, NoticesFaultyOracles) {
  EXPECT_EQ(rejected(point_triangle_distance, 96), 0);

  const Oracle rounds_inward = [](const Point& p, const std::array<Point, 3>& v) {
    const DistanceBounds d = point_triangle_distance(p, v);
    return DistanceBounds{d.lower, d.upper - 2e-14};
  };
  const Oracle lower_bound_too_high = [](const Point& p, const std::array<Point, 3>& v) {
    const DistanceBounds d = point_triangle_distance(p, v);
    return DistanceBounds{d.upper, d.upper};
  };
  // Edges that go on beyond their ends.
  const Oracle without_vertex_regions = [](const Point& p, const std::array<Point, 3>& v) {
    DistanceBounds d = point_triangle_distance(p, v);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point edge = (v[(i + 1) % 3] - v[i]).normalized(), to_p = p - v[i];
      d.upper = std::min(d.upper, (to_p - to_p.dot(edge) * edge).norm());
    }
    return DistanceBounds{0, d.upper};
  };
  const Oracle vertices_only = [](const Point& p, const std::array<Point, 3>& v) {
    return DistanceBounds{0, std::min({(v[0] - p).norm(), (v[1] - p).norm(), (v[2] - p).norm()})};
  };
  EXPECT_GT(rejected(rounds_inward, 96), 250);
  EXPECT_GT(rejected(lower_bound_too_high, 96), 250);
  EXPECT_GT(rejected(without_vertex_regions, 96), 100);
  EXPECT_GT(rejected(vertices_only, 96), 100);
}

}  // namespace
}  // namespace emax
