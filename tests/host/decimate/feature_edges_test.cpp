#include "host/decimate/feature_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "host/decimate/bounded_decimation.h"
#include "host/files/mesh_file.h"
#include "host/geometry/bounds.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kAngle = 40;

std::uint32_t vertex_at(const TriangleMesh& mesh, const Point& p) {
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if ((mesh.vertices[v] - p).norm() < 1e-9) return v;
  }
  return ~0u;
}

TEST(VertexClass, OfAPlaneAreSimpleInsideAndBoundaryAtTheRim) {
  const TriangleMesh mesh = sheet(5, 0);
  const FeatureEdges features(mesh, kAngle);
  EXPECT_TRUE(features.empty());
  EXPECT_EQ(features.vertex_class(vertex_at(mesh, {0, 0, 0})), VertexClass::kSimple);
  EXPECT_EQ(features.vertex_class(vertex_at(mesh, {-1, 0, 0})), VertexClass::kBoundary);
  EXPECT_EQ(features.vertex_class(vertex_at(mesh, {1, -1, 0})), VertexClass::kBoundary);
}

TEST(VertexClass, OfACubeAreSimpleOnFacesInteriorOnEdgesAndCorners) {
  const TriangleMesh mesh = cube(4);
  const FeatureEdges features(mesh, kAngle);
  EXPECT_EQ(features.vertex_class(vertex_at(mesh, {0, 0, 1})), VertexClass::kSimple);
  EXPECT_EQ(features.vertex_class(vertex_at(mesh, {1, 0, 1})), VertexClass::kInteriorEdge);
  EXPECT_EQ(features.vertex_class(vertex_at(mesh, {1, 1, -1})), VertexClass::kCorner);
  EXPECT_TRUE(features.on(vertex_at(mesh, {1, 0, 1}), vertex_at(mesh, {1, 0.5, 1})));
  EXPECT_FALSE(features.on(vertex_at(mesh, {1, 0, 1}), vertex_at(mesh, {0.5, 0, 1})));
}

TEST(VertexClass, WhereAFeatureEndsIsACorner) {
  // One turn about the middle, rising to where its two ends meet in a fold.
  constexpr std::uint32_t kSteps = 16;
  TriangleMesh mesh = {{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const double turn = (2.0 * i / kSteps - 1) * std::numbers::pi;
    mesh.vertices.push_back({std::cos(turn), std::sin(turn), std::pow(turn / std::numbers::pi, 2)});
    mesh.triangles.push_back({0, i + 1, (i + 1) % kSteps + 1});
  }
  const FeatureEdges features(mesh, kAngle / 2);
  EXPECT_TRUE(features.on(0, 1));
  EXPECT_EQ(features.vertex_class(0), VertexClass::kCorner);
}

TEST(VertexClass, WithoutAFanIsComplex) {
  TriangleMesh fin = cube(2);
  const std::uint32_t on_edge = vertex_at(fin, {1, 0, 1}), corner = vertex_at(fin, {1, 1, 1});
  fin.vertices.push_back({2, 0, 2});
  fin.triangles.push_back({on_edge, corner, static_cast<std::uint32_t>(fin.vertices.size() - 1)});
  const FeatureEdges of_fin(fin, kAngle);
  EXPECT_EQ(of_fin.vertex_class(on_edge), VertexClass::kComplex);
  EXPECT_EQ(of_fin.vertex_class(corner), VertexClass::kComplex);

  const TriangleMesh bow_tie = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                                {{0, 1, 2}, {0, 3, 4}}};
  const FeatureEdges of_tie(bow_tie, kAngle);
  EXPECT_EQ(of_tie.vertex_class(0), VertexClass::kComplex);
  EXPECT_EQ(of_tie.vertex_class(1), VertexClass::kBoundary);
}

TEST(FeatureEdges, SayHowACollapseKeepsThem) {
  using Collapse = FeatureEdges::Collapse;
  const TriangleMesh mesh = cube(4);
  const FeatureEdges features(mesh, kAngle);
  const auto between = [&](const Point& a, const Point& b) {
    return features.permitted(vertex_at(mesh, a), vertex_at(mesh, b));
  };
  EXPECT_EQ(between({0, 0, 1}, {0.5, 0, 1}), Collapse::kAnywhere);
  EXPECT_EQ(between({1, 0, 1}, {0.5, 0, 1}), Collapse::kAtFirst);
  EXPECT_EQ(between({0.5, 0, 1}, {1, 0, 1}), Collapse::kAtSecond);
  EXPECT_EQ(between({1, 0, 1}, {1, 0.5, 1}), Collapse::kAlong);
  EXPECT_EQ(between({1, 1, 1}, {1, 0.5, 1}), Collapse::kAtFirst);
  EXPECT_EQ(between({1, 0.5, 1}, {0.5, 1, 1}), Collapse::kForbidden);
}

TEST(FeatureEdges, GoThroughCollapses) {
  const TriangleMesh mesh = cube(4);
  FeatureEdges features(mesh, kAngle);
  const std::uint32_t a = vertex_at(mesh, {1, 0, 1}), b = vertex_at(mesh, {1, 0.5, 1}),
                      corner = vertex_at(mesh, {1, 1, 1});
  features.collapsed(a, b, mesh.vertices);
  EXPECT_TRUE(features.on(a, corner));
  EXPECT_FALSE(features.on(a, b));
  EXPECT_FALSE(features.on(b, corner));
  features.collapsed(a, corner, mesh.vertices);
  EXPECT_EQ(features.vertex_class(a), VertexClass::kCorner);
  EXPECT_TRUE(features.on(a, vertex_at(mesh, {1, 1, 0.5})));
}

TEST(FeatureEdges, AreKeptByVerticesThatWereAdded) {
  TriangleMesh mesh = cube(4);
  FeatureEdges features(mesh, kAngle);
  const auto added = static_cast<std::uint32_t>(mesh.vertices.size() + 3);
  const std::uint32_t b = vertex_at(mesh, {1, 0.5, 1}), corner = vertex_at(mesh, {1, 1, 1});
  EXPECT_FALSE(features.fixed(added));
  ASSERT_EQ(features.permitted(added, b), FeatureEdges::Collapse::kAtSecond);
  mesh.vertices.resize(added + 1, mesh.vertices[b]);
  features.collapsed(added, b, mesh.vertices);
  EXPECT_TRUE(features.fixed(added));
  EXPECT_TRUE(features.on(added, corner));
}

// A roof whose ridge, vertices 0 to `steps`, winds.
TriangleMesh winding_roof(std::uint32_t steps) {
  TriangleMesh mesh;
  for (const double side : {0.0, 1.0, -1.0}) {
    for (std::uint32_t i = 0; i <= steps; ++i) {
      const double turn = 0.2 * i;
      mesh.vertices.push_back({turn, std::sin(turn) + side, -2 * std::abs(side)});
    }
  }
  for (const std::uint32_t row : {steps + 1, 2 * (steps + 1)}) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      mesh.triangles.push_back({i, i + 1, row + i});
      mesh.triangles.push_back({i + 1, row + i + 1, row + i});
      if (row > steps + 1) continue;
      for (Triangle* t : {&mesh.triangles.back(), &mesh.triangles.back() - 1}) {
        std::swap((*t)[1], (*t)[2]);
      }
    }
  }
  return mesh;
}

double distance_from_chain(const Point& p, const std::vector<Point>& chain) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const Point along = chain[i + 1] - chain[i];
    const double share = along.dot(p - chain[i]) / along.squaredNorm();
    least = std::min(least, (p - chain[i] - std::clamp(share, 0.0, 1.0) * along).norm());
  }
  return least;
}

TEST(FeatureEdges, KeepEachVertexOfTheStartNear) {
  constexpr std::uint32_t kSteps = 60;
  constexpr double kDistance = 0.05;
  const TriangleMesh mesh = winding_roof(kSteps);
  std::vector<Point> positions = mesh.vertices;
  FeatureEdges features(mesh, kAngle);
  std::vector<std::uint32_t> ridge(kSteps + 1);
  std::iota(ridge.begin(), ridge.end(), 0u);
  const auto chain = [&] {
    std::vector<Point> points;
    for (const std::uint32_t v : ridge) points.push_back(positions[v]);
    return points;
  };
  std::mt19937 random(5);
  int refused = 0, vain = 0;
  for (; vain < 300; ++vain) {
    if (ridge.size() < 4) break;
    const std::size_t i = 1 + random() % (ridge.size() - 3);
    const std::uint32_t a = ridge[i], b = ridge[i + 1];
    ASSERT_EQ(features.permitted(a, b), FeatureEdges::Collapse::kAlong);
    const double share = 0.5 * static_cast<double>(random() % 3);
    const Point before = positions[a], at = before + share * (positions[b] - before);
    const bool permitted = features.stays_near(a, b, at, positions, kDistance * kDistance);
    positions[a] = at;
    ridge.erase(ridge.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    double worst = 0;
    for (std::uint32_t v = 0; v <= kSteps; ++v) {
      worst = std::max(worst, distance_from_chain(mesh.vertices[v], chain()));
    }
    EXPECT_EQ(permitted, worst <= kDistance) << worst;
    if (permitted) {
      vain = 0;
      features.collapsed(a, b, positions);
      continue;
    }
    ++refused;
    positions[a] = before;
    ridge.insert(ridge.begin() + static_cast<std::ptrdiff_t>(i) + 1, b);
  }
  EXPECT_GT(refused, 300);
  EXPECT_LT(ridge.size(), kSteps / 2);
  EXPECT_GT(ridge.size(), 10u);
}

// Points along the feature edges of a mesh, and these edges as triangles without area.
struct Sharp {
  Sharp(const TriangleMesh& mesh, double angle) {
    edges.vertices = mesh.vertices;
    const FeatureEdges features(mesh, angle);
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if (a > b || !features.on(a, b)) continue;
        edges.triangles.push_back({a, b, b});
        for (int k = 0; k <= 2; ++k) {
          points.push_back(mesh.vertices[a] + k / 2.0 * (mesh.vertices[b] - mesh.vertices[a]));
        }
      }
    }
  }
  double farthest_from(const Sharp& other) const {
    const ExactMesh exact(other.edges.view());
    double worst = 0;
    for (const Point& p : points) worst = std::max(worst, exact.distance(p).upper);
    return worst;
  }
  TriangleMesh edges;
  std::vector<Point> points;
};

TEST(FeatureEdges, OfAMachinePartStayWhereTheyAre) {
  const TriangleMesh mesh = read_mesh(EMAX_DATA_FOLDER "/fandisk.off");
  const ReferenceSurface reference = reference_surface(mesh, mesh.vertices, 1e-3);
  const Sharp before(reference.mesh, kAngle);
  ASSERT_GT(before.points.size(), 500u);
  DecimationSettings settings;
  settings.epsilon = 0.005 * bounds_of(mesh.vertices).width();
  settings.effort = DecimationSettings::Effort::kCollapse;
  const BoundedDecimator decimator(reference.mesh, mesh.vertices);
  const auto sharp_distance = [&] {
    const TriangleMesh result = decimator.run(settings).mesh;
    EXPECT_TRUE(check_mesh(result.view()).valid());
    EXPECT_LT(result.triangles.size(), mesh.triangles.size() / 10);
    return before.farthest_from(Sharp(result, kAngle / 2));
  };
  const double without = sharp_distance();
  settings.feature_angle = kAngle;
  const double with = sharp_distance();
  RecordProperty("without", std::to_string(without / settings.epsilon));
  RecordProperty("with", std::to_string(with / settings.epsilon));
  EXPECT_LE(with, 1.1 * settings.epsilon);
  EXPECT_GT(without, 2 * settings.epsilon);
}

}  // namespace
}  // namespace emax::test
