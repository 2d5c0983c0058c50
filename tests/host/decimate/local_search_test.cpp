#include "host/decimate/local_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kSearchLimit = 0.03;

// Steps along the axes, halved where none of them gains: slow, and without a derivative.
Fit compass_search(LocalSearch& search, Point at, int power) {
  Fit best;
  if (!search.evaluate(at, power, best)) return best;
  for (double step = 0.5 * kSearchLimit; step > 1e-7 * kSearchLimit;) {
    bool gained = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Fit next;
        const Point to = best.position + sign * step * Point::Unit(axis);
        if (!search.evaluate(to, power, next) || !(next.energy < best.energy)) continue;
        best = next;
        gained = true;
      }
    }
    if (!gained) step *= 0.5;
  }
  return best;
}

class Steps : public testing::TestWithParam<int> {};

TEST_P(Steps, OfNewtonReachWhatASlowSearchReaches) {
  const int power = GetParam();
  const TriangleMesh reference = bumpy(30, 50), mesh = bumpy(10, 16);
  const BackBound back(reference, kSearchLimit);
  DecimationState::Guards guards;
  guards.squared_reach = 1;
  const DecimationState state(mesh, reference.vertices, &back, kSearchLimit * kSearchLimit, guards);
  LocalSearch search(state);
  search.use(LocalSearch::Steps::kNewton);
  LocalSearch::Options options;
  options.power = power;
  options.steps = 30;
  options.gain = 1e-6;
  std::size_t as_low = 0, all = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    ASSERT_TRUE(search.prepare_relocation(v));
    Fit start, fit;
    if (!search.evaluate(mesh.vertices[v], power, start)) continue;
    ASSERT_TRUE(search.fit(mesh.vertices[v], options, fit));
    EXPECT_LE(fit.energy, start.energy);
    const Fit slow = compass_search(search, mesh.vertices[v], power);
    // As roots, which are about the greatest distance.
    const double found = std::pow(fit.energy, 1.0 / power);
    as_low += found <= 1.03 * std::pow(slow.energy, 1.0 / power) ? 1 : 0;
    ++all;
  }
  EXPECT_GT(all, 60u);
  // The power 64 is almost a maximum, and steps end where two distances are equally great.
  EXPECT_GT(as_low, power == 64 ? all / 2 : all * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Powers, Steps, testing::Values(2, 4, 16, 64));

// At an edge and inside; the new vertex goes to where the energy is least.
TEST(LocalSearch, SplitsReplaceTriangles) {
  const TriangleMesh reference = bumpy(30, 50), mesh = bumpy(10, 16);
  const BackBound back(reference, 1);
  DecimationState state(mesh, reference.vertices, &back, 1, {});
  LocalSearch search(state);
  for (const bool inside : {false, true}) {
    const Triangle t = state.mesh().triangle(40);
    const std::array<Point, 3> c = state.mesh().corners(40);
    const Point start = inside ? Point((c[0] + c[1] + c[2]) / 3) : Point(0.5 * (c[0] + c[1]));
    const std::uint32_t vertex = state.add_vertex(start);
    ASSERT_TRUE(inside ? search.prepare_split(40, vertex)
                       : search.prepare_split(t[0], t[1], vertex));
    const double before = search.energy_before(4);
    Fit fit;
    MeshEdit edit;
    ASSERT_TRUE(search.fit(start, {}, fit));
    EXPECT_LT(fit.energy, before);
    ASSERT_TRUE(search.finish(fit, true, edit));
    EXPECT_EQ(edit.removed.size(), inside ? 1u : 2u);
    EXPECT_EQ(edit.added.size(), inside ? 3u : 4u);
    const std::size_t triangles = state.mesh().triangles();
    ASSERT_TRUE(state.permits(edit));
    state.apply(edit);
    EXPECT_EQ(state.mesh().triangles(), triangles + 2);
  }
}

}  // namespace
}  // namespace emax::test
