#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/exact_distance.h"

namespace emax::test {
namespace {

constexpr int kSide = 30;
const JoiningDistance kFar(0.5, 0.9);

// Unit squares in the plane z = 0.
TriangleMesh plane() {
  TriangleMesh mesh;
  for (int y = 0; y <= kSide; ++y) {
    for (int x = 0; x <= kSide; ++x) mesh.vertices.push_back(Point(x, y, 0));
  }
  const auto at = [](int x, int y) { return static_cast<std::uint32_t>(y * (kSide + 1) + x); };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return mesh;
}

// A point over each square, as high as `height` says.
template <typename Height>
std::vector<Point> points_over(const Height& height) {
  std::vector<Point> points;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) points.push_back(Point(x + 0.4, y + 0.3, height(x, y)));
  }
  return points;
}

std::vector<Point> new_vertices(const TriangleMesh& mesh, const ReferenceSurface& reference) {
  std::vector<Point> found;
  for (const Point& v : reference.mesh.vertices) {
    if (std::ranges::count(mesh.vertices, v) == 0) found.push_back(v);
  }
  return found;
}

TEST(FarPoints, APointAloneIsNoiseUntilItIsFar) {
  const TriangleMesh mesh = plane();
  const auto joined = [&](double height) {
    const std::vector<Point> cloud =
        points_over([&](int x, int y) { return x == 10 && y == 10 ? height : 0.1; });
    return reference_surface(mesh, cloud, kFar).inserted;
  };
  EXPECT_EQ(joined(0.6), 0u);
  EXPECT_EQ(joined(-0.89), 0u);
  EXPECT_EQ(joined(0.91), 1u);
}

TEST(FarPoints, ARidgeIsWhatTheMeshLacks) {
  const TriangleMesh mesh = plane();
  const std::vector<Point> cloud = points_over([](int x, int) { return x == 10 ? 0.6 : 0.1; });
  const ReferenceSurface reference = reference_surface(mesh, cloud, kFar);
  EXPECT_TRUE(reference.left_out.empty());
  EXPECT_TRUE(certify(cloud, reference.mesh.view()).within(kFar.with_others));
}

TEST(FarPoints, APointAloneIsAsGoodAsAnyWhereMostAreNot) {
  const TriangleMesh mesh = plane();
  const auto height = [](int x, int y) { return x == 4 || (x == 15 && y == 10) ? 0.6 : 0.1; };
  const std::vector<Point> cloud = points_over(height);
  const ReferenceSurface reference = reference_surface(mesh, cloud, kFar);
  EXPECT_TRUE(certify(cloud, reference.mesh.view()).within(kFar.with_others));
}

TEST(FarPoints, NeighboursOnBothSidesAreNoise) {
  const std::vector<Point> cloud = points_over([](int x, int y) {
    return y != 10 ? 0.1 : x == 10 ? 0.6 : x == 11 ? -0.6 : 0.1;
  });
  EXPECT_EQ(reference_surface(plane(), cloud, kFar).inserted, 0u);
}

// Which points are alone, by all pairs.
TEST(FarPoints, JoinsThoseThatBruteForceNames) {
  const TriangleMesh mesh = plane();
  std::mt19937_64 random(17);
  std::normal_distribution<double> noise(0, 0.26);
  const std::vector<Point> cloud = points_over([&](int, int) { return noise(random); });
  const auto is_named = [&](const Point& p) {
    std::vector<std::pair<double, const Point*>> others;
    for (const Point& q : cloud) {
      if (&q != &p) others.emplace_back((p - q).squaredNorm(), &q);
    }
    std::ranges::sort(others);
    const auto is_so_too = [&](const auto& other) {
      const double z = other.second->z();
      return z * p.z() > 0 && std::abs(z) > kFar.with_others;
    };
    return std::abs(p.z()) > kFar.alone ||
           (std::abs(p.z()) > kFar.with_others &&
            std::any_of(others.begin(), others.begin() + 8, is_so_too));
  };
  const ReferenceSurface reference = reference_surface(mesh, cloud, kFar);
  EXPECT_TRUE(check_mesh(reference.mesh.view()).valid());
  std::size_t named = 0, alone = 0;
  for (const Point& p : cloud) {
    if (std::abs(p.z()) <= kFar.with_others) continue;
    ++(is_named(p) ? named : alone);
  }
  EXPECT_GT(named, 2u);
  EXPECT_GT(alone, 3 * named);  // else all would be joined
  for (const Point& v : new_vertices(mesh, reference)) EXPECT_TRUE(is_named(v));
  const ExactMesh exact(reference.mesh.view());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const bool is_left_out = std::ranges::binary_search(reference.left_out, i);
    const double limit = is_named(cloud[i]) ? kFar.with_others : kFar.alone;
    EXPECT_TRUE(is_left_out || exact.distance(cloud[i]).lower <= limit) << i;
  }
  EXPECT_EQ(new_vertices(mesh, reference).size(), reference.inserted);
}

}  // namespace
}  // namespace emax::test
