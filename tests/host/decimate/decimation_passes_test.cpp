#include "host/decimate/decimation_passes.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "host/geometry/mesh_validity.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

// A state and passes over it, of a mesh whose own vertices are the cloud unless one is given.
struct PassesBench {
  PassesBench(const TriangleMesh& mesh, double limit, std::vector<Point> points = {})
      : cloud(points.empty() ? mesh.vertices : std::move(points)),
        state(mesh, cloud, nullptr, limit * limit, {}),
        passes(state, {}, 1, [this](double done) {
          told.push_back(done);
          return stop;
        }) {}

  double energy() const {
    double sum = 0;
    for (std::uint32_t p = 0; p < cloud.size(); ++p) {
      const double share = state.assigned().squared_distance(p) / state.squared_limit();
      sum += share * share;
    }
    return sum;
  }
  void expect_all_within() const {
    for (std::uint32_t p = 0; p < cloud.size(); ++p) {
      ASSERT_LE(state.assigned().squared_distance(p), state.squared_limit()) << p;
    }
    EXPECT_TRUE(check_mesh(state.mesh().compact().view()).valid());
  }

  std::vector<Point> cloud;
  std::vector<double> told;
  bool stop = false;
  DecimationState state;
  DecimationPasses passes;
};

// Four corners, two of them raised, and the diagonal between the others.
TriangleMesh saddle() {
  return {{{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1, 0.2}}, {{0, 1, 2}, {0, 2, 3}}};
}

// Each collapse takes a vertex, and two triangles of a closed mesh.
TEST(DecimationPasses, CollapsesLeaveACubeItsCorners) {
  PassesBench bench(cube(4), 1e-3);
  const std::size_t vertices = bench.cloud.size();
  EXPECT_EQ(bench.passes.collapse(), vertices - 8);
  EXPECT_EQ(bench.state.mesh().triangles(), 12u);
  bench.expect_all_within();
  EXPECT_EQ(bench.passes.collapse(), 0u);
}

TriangleMesh noisy(TriangleMesh mesh) {
  Random random(named_seed("noisy", 1));
  for (Point& v : mesh.vertices) v += random.point(-0.02, 0.02);
  return mesh;
}

// Another pass judges every edge anew.
TEST(DecimationPasses, CollapsesLeaveNoEdgeThatCouldCollapse) {
  for (const TriangleMesh& mesh : {noisy(bumpy(20, 30)), noisy(cube(16))}) {
    PassesBench bench(mesh, 0.03);
    EXPECT_GT(bench.passes.collapse(true), 0u);
    bench.expect_all_within();
    EXPECT_EQ(bench.passes.collapse(true), 0u);
  }
}

TEST(DecimationPassesFault, WhatWasRefusedOnceIsLeft) {
  const DeliberateFault fault(Fault::kForgetsRefused);
  PassesBench bench(noisy(cube(16)), 0.03);
  bench.passes.collapse(true);
  const std::size_t triangles = bench.state.mesh().triangles();
  EXPECT_GT(10 * bench.passes.collapse(true), triangles);
}

TEST(DecimationPasses, SweepsCollapseFarBelowTheLimit) {
  PassesBench bench(bumpy(30, 50), 0.02);
  const std::size_t before = bench.state.mesh().triangles();
  const std::size_t swept = bench.passes.sweep();
  EXPECT_GT(swept, 100u);
  EXPECT_EQ(bench.state.mesh().triangles(), before - 2 * swept);
  bench.expect_all_within();
}

// The point lies on the other diagonal.
TEST(DecimationPasses, AFlipTurnsTheEdgeThatMissesThePoints) {
  TriangleMesh mesh = saddle();
  std::vector<Point> cloud = mesh.vertices;
  cloud.emplace_back(0.5, 0.5, 0.2);
  PassesBench bench(mesh, 0.3, cloud);
  EXPECT_GT(bench.energy(), 0.01);
  EXPECT_EQ(bench.passes.flip(4), 1u);
  EXPECT_LT(bench.energy(), 1e-12);
  EXPECT_EQ(bench.passes.flip(4), 0u);
}

TEST(DecimationPasses, NoEdgeIsTurnedForNothing) {
  PassesBench bench(saddle(), 0.3);
  EXPECT_EQ(bench.passes.flip(4), 0u);
}

// The apex of a pyramid stands too low for the points of its sides.
TEST(DecimationPasses, ARelocationMovesAVertexToItsPoints) {
  const auto pyramid = [](double height) {
    return TriangleMesh{{{0, 0, height}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                        {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
  };
  std::vector<Point> cloud;
  const TriangleMesh scanned = pyramid(0.5);
  for (const Triangle& t : scanned.triangles) {
    const auto at = [&](std::size_t i) { return scanned.vertices[t[i]]; };
    cloud.push_back((at(0) + at(1) + at(2)) / 3);
    cloud.push_back(0.5 * (at(0) + at(1)));
  }
  cloud.insert(cloud.end(), scanned.vertices.begin() + 1, scanned.vertices.end());
  PassesBench bench(pyramid(0.4), 0.2, cloud);
  const double before = bench.energy();
  EXPECT_GT(bench.passes.relocate(4), 0u);
  EXPECT_LT(bench.energy(), 0.01 * before);
  EXPECT_NEAR(bench.state.mesh().position(0).z(), 0.5, 0.02);
  bench.expect_all_within();
}

// A cube's corner cannot go within so little, and what was tried is taken back.
TEST(DecimationPasses, ATrialThatCannotBeMendedLeavesTheMeshAsItWas) {
  PassesBench bench(cube(1), 1e-3);
  const TriangleMesh before = bench.state.mesh().compact();
  EXPECT_EQ(bench.passes.collapse_and_mend(), 0u);
  EXPECT_TRUE(same_bytes(bench.state.mesh().compact(), before));
  bench.expect_all_within();
}

TEST(DecimationPasses, MendingCollapsesWhatCollapsesAloneCannot) {
  PassesBench bench(bumpy(30, 50), 0.02);
  bench.passes.sweep();
  bench.passes.collapse();
  const std::size_t before = bench.state.mesh().triangles();
  bench.state.reassign();
  const std::size_t mended = bench.passes.collapse_and_mend();
  EXPECT_GT(mended, 0u);
  EXPECT_EQ(bench.state.mesh().triangles(), before - 2 * mended);
  bench.expect_all_within();
}

// What is held keeps its triangles.
TEST(DecimationPasses, NothingMovesWhereVerticesAreHeld) {
  PassesBench bench(bumpy(30, 50), 0.02);
  const TriangleMesh before = bench.state.mesh().compact();
  const auto held = [&](const Point& p) { return (p - before.vertices[700]).norm() <= 0.5; };
  const auto triangles_held = [&](const TriangleMesh& mesh) {
    std::set<std::array<std::array<double, 3>, 3>> all;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::array<Point, 3> c = mesh.view().corners(t);
      if (!std::ranges::all_of(c, held)) continue;
      std::array<std::array<double, 3>, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = {c[i][0], c[i][1], c[i][2]};
      std::ranges::sort(corners);
      all.insert(corners);
    }
    return all;
  };
  const auto run = [&] {
    bench.passes.sweep();
    bench.passes.collapse();
    bench.passes.flip(4);
    bench.passes.relocate(4);
    bench.passes.collapse_and_mend();
    return bench.state.mesh().compact();
  };
  bench.passes.hold_around({{before.vertices[700], 0.5}});
  const TriangleMesh around = run();
  EXPECT_GT(triangles_held(before).size(), 50u);
  EXPECT_TRUE(std::ranges::includes(triangles_held(around), triangles_held(before)));
  EXPECT_LT(around.triangles.size(), before.triangles.size() / 2);
  bench.passes.free();
  EXPECT_LT(triangles_held(run()).size(), triangles_held(before).size() / 2);
}

TEST(DecimationPasses, TellHowFarTheyAreAndEndWhenToldTo) {
  PassesBench whole(bumpy(30, 50), 0.02);
  whole.passes.collapse();
  ASSERT_GT(whole.told.size(), 2u);
  EXPECT_TRUE(std::is_sorted(whole.told.begin(), whole.told.end()));
  EXPECT_GE(whole.told.front(), 0);
  EXPECT_LE(whole.told.back(), 1);
  EXPECT_FALSE(whole.passes.stopped());

  PassesBench ended(bumpy(30, 50), 0.02);
  ended.stop = true;
  EXPECT_EQ(ended.passes.collapse(), 0u);
  EXPECT_TRUE(ended.passes.stopped());
  EXPECT_EQ(ended.told.size(), 1u);
  ended.expect_all_within();
}

}  // namespace
}  // namespace emax::test
