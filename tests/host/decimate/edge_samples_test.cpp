#include "host/decimate/edge_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/decimate/local_search.h"
#include "sw_model/base/sort_once.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kSampleLimit = 0.05;
constexpr int kPower = 4;

// The greatest share at places spread over the edges at a vertex.
double greatest_at(std::uint32_t vertex, const Point& position, const EditableMesh& mesh,
                   const TriangleMesh& reference) {
  constexpr int kPlaces = 24;
  std::vector<std::uint32_t> ring;
  mesh.neighbours(vertex, ring);
  double greatest = 0;
  for (const std::uint32_t other : ring) {
    for (int i = 1; i < kPlaces; ++i) {
      const Point p =
          position + static_cast<double>(i) / kPlaces * (mesh.position(other) - position);
      greatest = std::max(greatest, share_of(p, reference, kSampleLimit));
    }
  }
  return greatest;
}

class CoarseMesh : public testing::TestWithParam<bool> {
 protected:
  CoarseMesh()
      : reference_(GetParam() ? bumpy(30, 50) : sheet(40, 0.4)),
        mesh_(GetParam() ? bumpy(14, 22) : sheet(12, 0.4)),
        back_(reference_, kSampleLimit),
        state_(mesh_, reference_.vertices, &back_, kSampleLimit * kSampleLimit, {}) {}

  std::vector<std::uint32_t> slots_at(std::uint32_t vertex) const {
    std::vector<std::uint32_t> slots;
    state_.mesh().slots_at(vertex, slots);
    return slots;
  }
  std::vector<Triangle> triangles_at(std::uint32_t vertex) const {
    std::vector<Triangle> triangles;
    for (const std::uint32_t slot : slots_at(vertex)) {
      triangles.push_back(state_.mesh().triangle(slot));
    }
    return triangles;
  }

  TriangleMesh reference_, mesh_;
  BackBound back_;
  DecimationState state_;
};

TEST_P(CoarseMesh, FindsWhereEdgesAreFarFromTheReference) {
  EdgeSamples samples(state_);
  samples.enable(true);
  std::size_t near = 0, all = 0;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); v += 3) {
    samples.take(slots_at(v), triangles_at(v), v);
    const double found = samples.measure(mesh_.vertices[v], kPower).worst;
    const double greatest = greatest_at(v, mesh_.vertices[v], state_.mesh(), reference_);
    // Far away sights are cut off at four times the limit.
    if (greatest > 1) continue;
    EXPECT_LE(found, greatest * 1.1 + 1e-3);
    near += std::sqrt(found) >= std::sqrt(greatest) - 0.15 ? 1 : 0;
    ++all;
  }
  EXPECT_GT(all, 40u);
  EXPECT_GT(near, all * 9 / 10);
}

TEST_P(CoarseMesh, MeasuresTheSameInPlaceAsBefore) {
  EdgeSamples samples(state_);
  samples.enable(true);
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); v += 5) {
    samples.take(slots_at(v), triangles_at(v), v);
    const double before = samples.energy_before(kPower);
    EXPECT_NEAR(samples.measure(mesh_.vertices[v], kPower).sum, before, 1e-9 + 1e-6 * before);
  }
}

// The twin forgets what it knew of the edges after every edit.
TEST_P(CoarseMesh, KnowsEdgesOnlyAsLongAsTheirEndsAreThere) {
  EdgeSamples samples(state_);
  samples.enable(true);
  LocalSearch search(state_);
  Random random(5);
  std::size_t moved = 0;
  for (int i = 0; i < 300; ++i) {
    const auto v = random.below(static_cast<std::uint32_t>(mesh_.vertices.size()));
    samples.take(slots_at(v), triangles_at(v), v);
    EdgeSamples anew(state_);
    anew.enable(true);
    anew.take(slots_at(v), triangles_at(v), v);
    const double energy = anew.energy_before(kPower);
    EXPECT_NEAR(samples.energy_before(kPower), energy, 1e-9 * (1 + energy));
    Fit fit;
    MeshEdit edit;
    const Point at = state_.mesh().position(v) + random.point(-0.01, 0.01);
    if (!search.prepare_relocation(v) || !search.evaluate(at, kPower, fit) ||
        !search.finish(fit, false, edit) || !state_.permits(edit, true)) {
      continue;
    }
    state_.apply(edit);
    ++moved;
  }
  EXPECT_GT(moved, 30u);
}

// What is known of a collapsed vertex's edges is where those of the other begin.
TEST_P(CoarseMesh, MeasuresACollapseFromTheEdgesThatWere) {
  std::size_t compared = 0, alike = 0;
  LocalSearch search(state_);
  for (std::uint32_t a = 0; a < mesh_.vertices.size(); a += 3) {
    std::vector<std::uint32_t> ring;
    state_.mesh().neighbours(a, ring);
    const std::uint32_t b = ring.front();
    if (!state_.mesh().collapsible(a, b)) continue;
    std::vector<Triangle> added;
    for (const std::uint32_t v : {a, b}) {
      for (Triangle t : triangles_at(v)) {
        if (has(t, a) && has(t, b)) continue;
        std::ranges::replace(t, b, a);
        added.push_back(t);
      }
    }
    std::vector<std::uint32_t> removed = slots_at(a);
    for (const std::uint32_t slot : slots_at(b)) removed.push_back(slot);
    sort_once(removed);
    EdgeSamples samples(state_), anew(state_);
    samples.enable(true);
    anew.enable(true);
    samples.take(removed, added, a, b);
    anew.take(removed, added, a);
    const double found = samples.measure(state_.mesh().position(a), kPower).worst;
    const double expected = anew.measure(state_.mesh().position(a), kPower).worst;
    if (expected > 1) continue;
    ++compared;
    alike += std::abs(std::sqrt(found) - std::sqrt(expected)) < 0.15 ? 1 : 0;
  }
  EXPECT_GT(compared, 10u);
  EXPECT_GE(alike, compared * 3 / 4);
}

// The slope of the sum of powers, by differences.
TEST_P(CoarseMesh, PointsAStepDownTheSlope) {
  EdgeSamples samples(state_);
  samples.enable(true);
  Random random(31);
  std::size_t compared = 0, alike = 0;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); v += 3) {
    samples.take(slots_at(v), triangles_at(v), v);
    const Point at = mesh_.vertices[v];
    const Point direction = random.point(-1, 1).normalized();
    const double step = 1e-6 * kSampleLimit;
    const double up = samples.measure(at + step * direction, kPower).sum;
    const double down = samples.measure(at - step * direction, kPower).sum;
    const EdgeSamples::Energy here = samples.measure(at, kPower);
    if (!(here.worst > 1e-4) || here.worst > 1) continue;
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Point right = Point::Zero();
    samples.add_to(matrix, right, at, 1, kPower);
    // d/dx of (d^2/L^2)^(p/2), where `right` is the sum of (d^2/L^2)^(p/2 - 1) times the residual.
    const double slope = -kPower / (kSampleLimit * kSampleLimit) * right.dot(direction);
    const double found = (up - down) / (2 * step);
    const double tolerance = 0.02 * std::abs(slope) + 0.02 * here.sum / kSampleLimit;
    alike += std::abs(found - slope) <= tolerance ? 1 : 0;
    ++compared;
  }
  EXPECT_GT(compared, 10u);
  // All but those with a place where the nearest triangle of the reference changes.
  EXPECT_GT(alike, compared * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, CoarseMesh, testing::Bool(),
                         [](const auto& param) { return param.param ? "Closed" : "Open"; });

TEST(EdgeSamples, NoneWithoutABackBoundOrPlaces) {
  const TriangleMesh mesh = sheet(5, 0.2);
  const BackBound back(mesh, kSampleLimit);
  const DecimationState one_sided(mesh, mesh.vertices, nullptr, kSampleLimit * kSampleLimit, {});
  const DecimationState both(mesh, mesh.vertices, &back, kSampleLimit * kSampleLimit, {});
  EdgeSamples samples(one_sided), none(both);
  samples.enable(true);
  EXPECT_TRUE(samples.none());
  EXPECT_TRUE(none.none());
}

}  // namespace
}  // namespace emax::test
