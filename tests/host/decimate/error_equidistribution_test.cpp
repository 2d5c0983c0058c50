#include "host/decimate/error_equidistribution.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

// The vertices, the middles of the edges and more places along the border.
std::vector<Point> with_samples(const TriangleMesh& mesh) {
  constexpr int kOnBorder = 8;
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.insert({t[i], t[(i + 1) % 3]});
  }
  std::vector<Point> points = mesh.vertices;
  for (const auto& [from, to] : edges) {
    const Point &a = mesh.vertices[from], &b = mesh.vertices[to];
    const int parts = edges.contains({to, from}) ? 2 : kOnBorder;
    for (int i = 1; i < parts; ++i) points.push_back(a + static_cast<double>(i) / parts * (b - a));
  }
  return points;
}

// A state under all bounds of a reference, its passes, and what stops them.
struct EquidistributionBench {
  EquidistributionBench(const TriangleMesh& mesh, double at_most)
      : reference(mesh),
        limit(at_most),
        back(reference, limit),
        cloud(with_samples(reference)),
        state(reference, cloud, &back, limit * limit, {}, nullptr, reference.triangles),
        passes(state, {}, 2, [this](double) { return polls == 0 || --polls == 0; }) {}

  bool run(const ErrorEquidistribution::Extent& extent = ErrorEquidistribution::kLong) {
    return ErrorEquidistribution(state, passes, extent, race,
                                 [this](const char*, std::size_t) {
                                   most = std::max(most, state.mesh().triangles());
                                 })
        .run();
  }
  // As few triangles as collapses leave; from then on the limits are twice as wide.
  void loosen() {
    passes.collapse();
    passes.use(LocalSearch::Steps::kNewton);
    state.loosen(2, 2);
  }
  // Leaves a mesh beyond its limits.
  void take_too_many() {
    loosen();
    passes.collapse_to(state.mesh().triangles() * 9 / 10, 8);
    state.tighten();
  }
  TriangleMesh mesh() const { return state.mesh().compact(); }
  // Nothing here is of the decimator's own.
  void expect_within() const {
    const TriangleMesh found = mesh();
    const ExactMesh exact(found.view()), exact_reference(reference.view());
    EXPECT_TRUE(check_mesh(found.view()).valid());
    EXPECT_TRUE(certify(reference.vertices, found.view(), {}).within(limit * (1 + 1e-9)));
    for (const auto& [of, to] :
         {std::pair{found.view(), &exact_reference}, std::pair{reference.view(), &exact}}) {
      EXPECT_LE(decided_distance(of, *to, limit * (1 + 1e-9)).lower, limit * (1 + 1e-9));
    }
  }

  const TriangleMesh reference;
  const double limit;
  long polls = 1'000'000'000;
  std::size_t most = 0;
  Race race{0};
  BackBound back;
  std::vector<Point> cloud;
  DecimationState state;
  DecimationPasses passes;
};

TEST(ErrorEquidistribution, NeedsFewerTrianglesThanCollapsesWithinTheLimits) {
  for (const auto& [mesh, limit] :
       {std::pair{bumpy(50, 80), 0.02}, std::pair{sheet(40, 0.3), 0.01}}) {
    EquidistributionBench bench(mesh, limit);
    bench.passes.sweep();
    bench.passes.collapse();
    const std::size_t before = bench.state.mesh().triangles();
    ASSERT_TRUE(bench.run());
    EXPECT_LT(bench.state.mesh().triangles(), before * 19 / 20);
    bench.expect_within();
    // The limits hold from now on.
    bench.passes.relocate(4);
    bench.expect_within();
  }
}

// A noisy cloud far denser than the reference, of which few points guide the searches.
TEST(ErrorEquidistribution, KeepsPointsWithinTheLimitThatDoNotGuide) {
  const TriangleMesh reference = sheet(24, 0.3);
  const double limit = 0.02;
  const BackBound back(reference, limit);
  std::vector<Point> cloud = with_samples(reference);
  Random random(8);
  for (std::size_t i = 0; i < 40 * reference.triangles.size(); ++i) {
    const auto& [a, b, c] = reference.triangles[i % reference.triangles.size()];
    const Point weights = random.point(0.05, 1);
    const Point at = weights[0] * reference.vertices[a] + weights[1] * reference.vertices[b] +
                     weights[2] * reference.vertices[c];
    cloud.push_back(at / weights.sum() + random.point(-0.1 * limit, 0.1 * limit));
  }
  DecimationState::Guards guards;
  guards.guides = 50;
  DecimationState state(reference, cloud, &back, limit * limit, guards, nullptr,
                        reference.triangles);
  EXPECT_FALSE(state.assigned().all_are_guides());
  DecimationPasses passes(state, {}, 2, nullptr);
  passes.sweep();
  passes.collapse();
  EXPECT_TRUE(certify(cloud, state.mesh().compact().view(), {}).within(limit));
  const std::size_t collapsed = state.mesh().triangles();
  Race race(0);
  ErrorEquidistribution even(state, passes, ErrorEquidistribution::kShort, race,
                             [](const char*, std::size_t) {});
  ASSERT_TRUE(even.run());
  const TriangleMesh found = state.mesh().compact();
  EXPECT_LT(found.triangles.size(), collapsed);
  EXPECT_TRUE(certify(cloud, found.view(), {}).within(limit * (1 + 1e-9)));
  for (std::uint32_t p = 0; p < cloud.size(); ++p) {
    ASSERT_NE(state.assigned().owner(p), kNoIndex) << p;
    EXPECT_FALSE(state.assigned().detached(p)) << p;
  }
}

// Over a rough reference edges are farthest from it at several places.
TEST(ErrorEquidistribution, RestoresTheLimitsOverARoughReference) {
  TriangleMesh rough = bumpy(50, 80);
  Random random(3);
  for (Point& p : rough.vertices) p += random.point(-0.004, 0.004);
  EquidistributionBench bench(rough, 0.02);
  EXPECT_GT(bench.back.usual_rise(), 0.3 * bench.limit);
  bench.passes.sweep();
  bench.passes.collapse();
  const std::size_t before = bench.state.mesh().triangles();
  ASSERT_TRUE(bench.run(ErrorEquidistribution::kShort));
  EXPECT_LT(bench.state.mesh().triangles(), before * 9 / 10);
  bench.expect_within();
}

// The point is farther from the reference than the mesh may go towards it.
TEST(ErrorEquidistribution, SaysWhereTheLimitsCannotBeRestored) {
  const TriangleMesh reference = sheet(24, 0.3);
  const double limit = 0.02;
  const Point far = reference.vertices[300] + Point(0, 0, 2.6 * limit);
  const BackBound back(reference, limit);
  std::vector<Point> cloud = with_samples(reference);
  cloud.push_back(far);
  DecimationState::Guards guards;
  guards.squared_reach = 9 * limit * limit;
  DecimationState state(reference, cloud, &back, limit * limit, guards, nullptr,
                        reference.triangles);
  DecimationPasses passes(state, {}, 1, nullptr);
  passes.sweep();
  passes.collapse();
  Race race(0);
  ErrorEquidistribution even(state, passes, ErrorEquidistribution::kShort, race,
                             [](const char*, std::size_t) {});
  EXPECT_FALSE(even.run());
  ASSERT_FALSE(even.stuck().empty());
  for (const DecimationPasses::Place& place : even.stuck()) {
    EXPECT_LT((place.at - far).norm(), place.radius + 3 * limit);
  }
}

// Stopped while it thins, it leaves the last mesh within its limits.
TEST(ErrorEquidistribution, ThinsWhatIsWithinTheLimits) {
  const TriangleMesh surface = sheet(30, 0.3);
  ErrorEquidistribution::Extent extent = ErrorEquidistribution::kLong;
  extent.thinnings = 0;
  EquidistributionBench plain(surface, 0.01), thinned(surface, 0.01), stopped(surface, 0.01);
  for (EquidistributionBench* bench : {&plain, &thinned, &stopped}) {
    bench->passes.sweep();
    bench->passes.collapse();
  }
  ASSERT_TRUE(plain.run(extent));
  const std::size_t triangles = plain.state.mesh().triangles();

  ASSERT_TRUE(thinned.run());
  EXPECT_LT(thinned.state.mesh().triangles(), triangles);
  thinned.expect_within();

  stopped.polls -= (plain.polls + thinned.polls) / 2;  // amid the thinnings
  ASSERT_TRUE(stopped.run());
  EXPECT_TRUE(stopped.passes.stopped());
  EXPECT_LE(stopped.state.mesh().triangles(), triangles);
  EXPECT_GE(stopped.state.mesh().triangles(), thinned.state.mesh().triangles());
  stopped.expect_within();
}

// Wherever it is stopped, it does not call a mesh within its limits that is not.
TEST(ErrorEquidistribution, SaysThatAStoppedMeshIsNotWithin) {
  std::size_t beyond = 0;
  for (const long polls : {1, 30, 200, 400}) {
    EquidistributionBench bench(bumpy(30, 50), 0.01);
    bench.passes.collapse();
    const DecimationState::Snapshot before = bench.state.snapshot();
    const TriangleMesh kept = bench.mesh();
    bench.polls = polls;
    EXPECT_FALSE(bench.run());
    EXPECT_TRUE(bench.passes.stopped());
    bench.state.tighten();
    beyond += bench.passes.beyond_limit().empty() ? 0 : 1;
    bench.state.restore(before);
    EXPECT_TRUE(same_bytes(bench.mesh(), kept));
    bench.expect_within();
  }
  EXPECT_GT(beyond, 0u);
}

TEST(EquidistributionPasses, CollapseAndSplitToTheirTargets) {
  EquidistributionBench bench(bumpy(30, 50), 0.01);
  bench.loosen();
  const std::size_t start = bench.state.mesh().triangles();
  const std::size_t collapses = bench.passes.collapse_to(start - 20, 8);
  EXPECT_EQ(bench.state.mesh().triangles(), start - 2 * collapses);
  EXPECT_LE(bench.state.mesh().triangles(), start - 20);
  EXPECT_GE(bench.state.mesh().triangles(), start - 21);
  const std::size_t splits = bench.passes.split_to(start, 8);
  EXPECT_EQ(splits, collapses);
  EXPECT_EQ(bench.state.mesh().triangles(), start);
  EXPECT_TRUE(check_mesh(bench.mesh().view()).valid());
}

// By every point and every triangle, and by the interval of the surface distance.
TEST(EquidistributionPasses, FindEveryTriangleBeyondALimit) {
  EquidistributionBench bench(bumpy(30, 50), 0.01);
  bench.take_too_many();
  const std::vector<std::uint32_t> found = bench.passes.beyond_limit();
  ASSERT_GT(found.size(), 5u);
  const ExactMesh exact(bench.reference.view());
  const EditableMesh& mesh = bench.state.mesh();
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    if (!mesh.alive(slot)) continue;
    bool point_beyond = false;
    bench.state.assigned().for_each(slot, [&](std::uint32_t p) {
      point_beyond = point_beyond || squared_distance(bench.state.point(p), mesh.corners(slot)) >
                                         bench.limit * bench.limit;
    });
    const std::array<Point, 3> corners = mesh.corners(slot);
    const std::vector<Triangle> one = {{0, 1, 2}};
    const SurfaceDistance back = decided_distance({corners, one}, exact, bench.limit);
    const bool listed = std::ranges::find(found, slot) != found.end();
    const bool within = !point_beyond && back.upper < 0.98 * bench.limit;
    EXPECT_TRUE(listed || !(point_beyond || back.lower > bench.limit)) << slot;
    EXPECT_FALSE(listed && within) << slot;
  }
}

TEST(EquidistributionPasses, SplitsAtTheWorstPlaceLowerTheWorst) {
  EquidistributionBench bench(bumpy(30, 50), 0.01);
  bench.take_too_many();
  std::vector<std::uint32_t> beyond = bench.passes.beyond_limit();
  const std::size_t first = beyond.size();
  ASSERT_GT(first, 5u);
  for (int round = 0; round < 10 && !beyond.empty(); ++round) {
    EXPECT_GT(bench.passes.split_at_worst(beyond, 16), 0u);
    bench.passes.relax_around(bench.passes.beyond_limit(), 2, 16);
    beyond = bench.passes.beyond_limit();
  }
  EXPECT_LT(beyond.size(), first / 4);
  EXPECT_TRUE(check_mesh(bench.mesh().view()).valid());
}

}  // namespace
}  // namespace emax::test
