#include "host/decimate/true_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "host/decimate/bounded_decimation.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

constexpr double kSpacing = 0.04;

double to_segment(const Point& p, const Point& from, const Point& to) {
  const double share = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
  return (p - from - share * (to - from)).norm();
}

// Of the cube [-1, 1]^3.
double to_edge_of_cube(const Point& p) {
  Point away = (p.cwiseAbs() - Point::Ones()).cwiseAbs();
  std::ranges::sort(away);
  return std::hypot(away[0], away[1]);
}

struct NoisyCube {
  TriangleMesh mesh = cube(14);
  std::vector<Shape> shapes;
  std::vector<std::uint32_t> shape_of;

  NoisyCube() {
    Random random(named_seed("true edges", 1));
    for (int i = 0; i < 6; ++i) {
      shapes.push_back(Plane{Point::Unit(i % 3), i < 3 ? 1.0 : -1.0});
    }
    for (const Triangle& t : mesh.triangles) {
      const Point middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
      const auto nearest = std::ranges::min_element(
          shapes, {}, [&](const Shape& shape) { return distance(shape, middle); });
      shape_of.push_back(static_cast<std::uint32_t>(nearest - shapes.begin()));
    }
    for (Point& v : mesh.vertices) v += random.point(-0.01, 0.01);
  }
};

TEST(TrueEdges, OfANoisyCubeAreItsOwn) {
  const NoisyCube noisy;
  const std::vector<Point> samples =
      sample_true_edges(noisy.mesh, noisy.shapes, noisy.shape_of, false, kSpacing);
  for (const Point& p : samples) EXPECT_LT(to_edge_of_cube(p), 1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    for (int edge = 0; edge < 4; ++edge) {
      for (double t = -0.95; t < 1; t += 0.1) {
        Point p = Point::Constant(t);
        p[(axis + 1) % 3] = edge < 2 ? -1 : 1;
        p[(axis + 2) % 3] = edge % 2 == 0 ? -1 : 1;
        EXPECT_TRUE(std::ranges::any_of(
            samples, [&](const Point& s) { return (s - p).norm() < 1.5 * kSpacing; }));
      }
    }
  }
}

TEST(TrueEdges, OfTrianglesWithoutAShapeCountOnSmoothSurfaces) {
  const TriangleMesh mesh = cube(3);
  const std::vector<std::uint32_t> none(mesh.triangles.size(), kNoIndex);
  EXPECT_TRUE(sample_true_edges(mesh, {}, none, false, kSpacing).empty());
  const std::vector<Point> samples = sample_true_edges(mesh, {}, none, true, kSpacing);
  EXPECT_GT(samples.size(), 12 * 40u);
  for (const Point& p : samples) EXPECT_LT(to_edge_of_cube(p), 1e-12);
}

// Of a cube whose corners are moved: its edges and the moved places of the samples are known.
struct BentCube {
  TriangleMesh mesh = cube(1);
  std::vector<Point> samples;
  DecimationState state;

  BentCube() : state(bend(mesh), mesh.vertices, nullptr, 1, {}) {
    const TriangleMesh straight = cube(1);
    const std::vector<std::uint32_t> none(straight.triangles.size(), kNoIndex);
    samples = sample_true_edges(straight, {}, none, true, 0.1);
  }
  static const TriangleMesh& bend(TriangleMesh& mesh) {
    Random random(named_seed("bent cube", 1));
    for (Point& v : mesh.vertices) v += random.point(-0.1, 0.1);
    return mesh;
  }
  // All with all: of the samples nearest to an edge at the vertex, with the vertex there.
  double distance(std::uint32_t vertex, const Point& there) const {
    double sum = 0;
    for (const Point& p : samples) {
      double least = 10;
      std::array<std::uint32_t, 2> nearest{};
      for_each_edge([&](std::uint32_t a, std::uint32_t b) {
        const double found = to_segment(p, mesh.vertices[a], mesh.vertices[b]);
        if (found < least) least = found, nearest = {a, b};
      });
      if (nearest[0] != vertex && nearest[1] != vertex) continue;
      const std::uint32_t other = nearest[0] == vertex ? nearest[1] : nearest[0];
      sum += to_segment(p, there, mesh.vertices[other]);
    }
    return sum;
  }
  // The twelve edges between corners that differ in one coordinate.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::uint32_t a = 0; a < mesh.vertices.size(); ++a) {
      for (std::uint32_t b = a + 1; b < mesh.vertices.size(); ++b) {
        const Point apart = (mesh.vertices[a] - mesh.vertices[b]).cwiseAbs();
        if ((apart.array() > 1).count() == 1) visit(a, b);
      }
    }
  }
};

TEST(TrueEdges, AreAsFarAsAllWithAllTells) {
  const BentCube bent;
  TrueEdges edges(bent.samples, 1);
  edges.assign(bent.state);
  for (std::uint32_t v = 0; v < bent.mesh.vertices.size(); ++v) {
    for (const Point& there : {bent.mesh.vertices[v], Point(0.9 * bent.mesh.vertices[v])}) {
      EXPECT_NEAR(edges.distance(bent.state.mesh(), v, there), bent.distance(v, there), 1e-12);
    }
  }
}

TEST(TrueEdges, StepsComeNearer) {
  const BentCube bent;
  TrueEdges edges(bent.samples, 1);
  edges.assign(bent.state);
  for (std::uint32_t v = 0; v < bent.mesh.vertices.size(); ++v) {
    const Point& at = bent.mesh.vertices[v];
    Point to = at;
    for (int i = 0; i < 5; ++i) {
      to = edges.step(bent.state.mesh(), v, to, Eigen::Matrix3d::Identity());
    }
    EXPECT_LT(bent.distance(v, to), 0.9 * bent.distance(v, at));
    const Eigen::Matrix3d up = Point::UnitZ() * Point::UnitZ().transpose();
    const Point along = edges.step(bent.state.mesh(), v, at, up);
    EXPECT_LT((along - at).head<2>().norm(), 1e-12);
  }
}

TEST(TrueEdges, BeyondReachBelongToNone) {
  const BentCube bent;
  TrueEdges edges(bent.samples, 1e-6);
  edges.assign(bent.state);
  for (std::uint32_t v = 0; v < bent.mesh.vertices.size(); ++v) {
    EXPECT_EQ(edges.distance(bent.state.mesh(), v, bent.mesh.vertices[v]), 0);
    EXPECT_EQ(edges.step(bent.state.mesh(), v, Point::Zero(), Eigen::Matrix3d::Identity()),
              Point::Zero());
  }
}

// The mean distance of the rims of a can from the edges of a mesh between its end and its side.
double rim_distance(const TriangleMesh& mesh) {
  constexpr int kPlaces = 720;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / kPlaces;
    const Point p(std::cos(angle), std::sin(angle), 1);
    double nearest = 1;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Point &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
        // The end's triangles turn with the rim, those of the side against it.
        const bool rim = a.z() > 0.9 && b.z() > 0.9 && std::hypot(a.x() + b.x(), a.y() + b.y()) > 1;
        if (rim) nearest = std::min(nearest, to_segment(p, a, b));
      }
    }
    sum += nearest / kPlaces;
  }
  return sum;
}

TriangleMesh decimated_can(std::size_t threads = 1) {
  const TriangleMesh mesh = can(60, 20);
  DecimationSettings settings = with(0.02);
  settings.planes = std::make_shared<const PlaneParts>(find_plane_parts(mesh.vertices, 0.02, 1));
  settings.spread_on_planes = true;
  settings.threads = threads;
  return BoundedDecimator(mesh, mesh.vertices).run(settings).mesh;
}

TEST(TrueEdges, OfACanAreTheSameForAnyNumberOfThreads) {
  EXPECT_TRUE(same_bytes(decimated_can(3), decimated_can()));
}

// As they are without any.
TEST(TrueEdgesFault, ThatForgetsTrueEdgesIsSeen) {
  const TriangleMesh near = decimated_can();
  const DeliberateFault fault(Fault::kForgetsTrueEdges);
  const TriangleMesh far = decimated_can();
  EXPECT_EQ(near.triangles.size(), far.triangles.size());
  EXPECT_LT(rim_distance(near), 0.9 * rim_distance(far));
}

}  // namespace
}  // namespace emax::test
