#include "host/surface/edge_flips.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/surface/manifold_part.h"

namespace emax::test {
namespace {

// Cells of side 1, n x n, at heights over (x, y); the diagonal of a cell runs either way.
template <class Height, class Falling>
TriangleMesh grid(std::uint32_t n, const Height& height, const Falling& falling) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) mesh.vertices.emplace_back(x, y, height(x, y));
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
      if (falling(x, y)) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    }
  }
  return mesh;
}

std::set<std::pair<std::uint32_t, std::uint32_t>> edges_of(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  }
  return edges;
}

// The brute-force twin: every edge flipped by itself, the whole sum computed anew.
double best_single_flip(const TriangleMesh& mesh) {
  const double before = total_turn(mesh);
  const auto edges = edges_of(mesh);
  double best = 0;
  const auto normal = [](const TriangleMesh& of, std::size_t t) {
    const auto [a, b, c] = of.view().corners(t);
    return Point((b - a).cross(c - a));
  };
  const auto thickness = [&](const TriangleMesh& of, std::size_t t) {
    const auto [a, b, c] = of.view().corners(t);
    return normal(of, t).norm() /
           std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
        for (std::size_t l = 0; l < 3; ++l) {
          if (mesh.triangles[j][l] != b || mesh.triangles[j][(l + 1) % 3] != a) continue;
          const std::uint32_t c = mesh.triangles[i][(k + 2) % 3];
          const std::uint32_t d = mesh.triangles[j][(l + 2) % 3];
          if (edges.contains(std::minmax(c, d))) continue;
          TriangleMesh flipped = mesh;
          flipped.triangles[i] = {a, d, c};
          flipped.triangles[j] = {d, b, c};
          const Point mean = normal(mesh, i).normalized() + normal(mesh, j).normalized();
          if (!(normal(flipped, i).dot(mean) > 0) || !(normal(flipped, j).dot(mean) > 0)) continue;
          const double thin = std::min(thickness(flipped, i), thickness(flipped, j));
          if (thin < kThinnest && thin < std::min(thickness(mesh, i), thickness(mesh, j))) continue;
          best = std::max(best, before - total_turn(flipped));
        }
      }
    }
  }
  return best;
}

TEST(FlipEdges, LeavesNoFlipThatIsWorthIt) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> height(-0.4, 0.4);
    TriangleMesh mesh = grid(
        7, [&](auto, auto) { return height(random); },
        [&](auto, auto) { return random() % 2 == 0; });
    const TriangleMesh before = mesh;
    ASSERT_GT(best_single_flip(before), 1e-3) << "seed " << seed;
    EXPECT_GT(flip_edges(mesh), 0u);
    EXPECT_LT(total_turn(mesh), total_turn(before));
    EXPECT_LT(best_single_flip(mesh), 1e-7) << "seed " << seed;
    EXPECT_EQ(mesh.vertices, before.vertices);
    EXPECT_EQ(mesh.triangles.size(), before.triangles.size());
    EXPECT_TRUE(topology_of(mesh.view()) == topology_of(before.view()));
    EXPECT_TRUE(check_mesh(mesh.view()).valid());
  }
}

// Of a cylinder's edges those along its axis need not turn: diagonals run wherever they may, but on
// a ridge across the cells all of them run along it.
TEST(FlipEdges, FindsARidge) {
  const auto ridge = [](double x, double y) { return -std::abs(x - y); };
  TriangleMesh mesh = grid(12, ridge, [](auto, auto) { return true; });
  const TriangleMesh along = grid(12, ridge, [](auto, auto) { return false; });
  ASSERT_GT(total_turn(mesh), 1.5 * total_turn(along));
  flip_edges(mesh);
  EXPECT_LE(total_turn(mesh), total_turn(along) * (1 + 1e-9));
  for (std::uint32_t i = 0; i < 12; ++i) {
    EXPECT_TRUE(edges_of(mesh).contains({i * 14, (i + 1) * 14})) << i;
  }
}

// Where all is flat but for rounding, no flip is worth it, and none follows another for ever.
TEST(FlipEdges, EndsWhereThereIsOnlyRounding) {
  TriangleMesh mesh = grid(
      40, [](auto, auto) { return 0; }, [](auto x, auto y) { return (x + y) % 2 == 0; });
  const Eigen::AngleAxisd turn(0.7, Point(1, 2, 3).normalized());
  for (Point& p : mesh.vertices) p = turn * p + Point(1000, 2000, 3000);
  EXPECT_EQ(flip_edges(mesh), 0u);
}

// A tip just under the middle of a cell whose diagonal runs beside it: the better diagonal would
// cut the tip.
TEST(FlipEdges, DoNotReachThroughAnotherSheet) {
  const auto ridge = [](double x, double y) { return -std::abs(x - y); };
  TriangleMesh mesh = grid(4, ridge, [](auto, auto) { return true; });
  TriangleMesh alone = mesh;
  flip_edges(alone);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{1.5, 1.5, -0.2}, {1.6, 1.5, 4}, {1.5, 1.6, 4}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  ASSERT_TRUE(check_mesh(mesh.view()).valid());
  TriangleMesh through = alone;
  through.vertices = mesh.vertices;
  through.triangles.push_back(mesh.triangles.back());
  ASSERT_FALSE(check_mesh(through.view()).valid());
  const double before = total_turn(mesh);
  EXPECT_GT(flip_edges(mesh), 0u);
  EXPECT_LT(total_turn(mesh), before);
  EXPECT_TRUE(check_mesh(mesh.view()).valid());
}

}  // namespace
}  // namespace emax::test
