#include "host/decimate/hoppe_energy.h"

#include <gtest/gtest.h>

#include <set>

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/local_search.h"
#include "host/geometry/bounds.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kEnergyLimit = 0.05;

// From the definition, with the true distances of all points.
HoppeEnergy directly(const TriangleMesh& mesh, std::span<const Point> cloud, double width,
                     const HoppeWeights& weights) {
  HoppeEnergy energy;
  const ExactMesh exact(mesh.view());
  for (const Point& p : cloud) {
    const double distance = exact.distance(p).upper / width;
    energy.distance += distance * distance;
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
  }
  for (const auto& [a, b] : edges) {
    const double length = (mesh.vertices[a] - mesh.vertices[b]).norm() / width;
    energy.spring += weights.spring * length * length;
  }
  energy.representation = weights.representation * static_cast<double>(mesh.vertices.size());
  return energy;
}

TEST(HoppeEnergy, IsThatOfItsDefinition) {
  for (const TriangleMesh& mesh : {bumpy(12, 20), sheet(9, 0.3)}) {
    std::vector<Point> cloud;
    Random random(5);
    for (const Point& p : mesh.vertices) cloud.push_back(p + 0.02 * random.point(-1, 1));
    const double width = bounds_of(mesh.vertices).width();
    const HoppeWeights weights = {1e-4, 1e-3};
    const DecimationState state(mesh, cloud, nullptr, kEnergyLimit * kEnergyLimit, {});
    const HoppeEnergy found = hoppe_energy(state, width, weights);
    const HoppeEnergy expected = directly(mesh, cloud, width, weights);
    EXPECT_NEAR(found.distance, expected.distance, 1e-9 * expected.distance);
    EXPECT_NEAR(found.spring, expected.spring, 1e-12 * expected.spring);
    EXPECT_NEAR(found.representation, expected.representation, 1e-12);
  }
}

// What the local search says an edit gains is what the whole energy gains.
TEST(HoppeEnergy, OfAnEditIsTheDifferenceOfTheWhole) {
  for (const TriangleMesh& mesh : {bumpy(12, 20), sheet(9, 0.3)}) {
    const double width = bounds_of(mesh.vertices).width();
    const HoppeWeights weights = {0, 0.02};
    DecimationState state(mesh, mesh.vertices, nullptr, kEnergyLimit * kEnergyLimit, {});
    LocalSearch search(state, weights.spring);
    Random random(7);
    std::array<int, 3> made{};
    for (int i = 0; i < 300; ++i) {
      std::uint32_t slot = 0;
      do slot = random.below(static_cast<std::uint32_t>(state.mesh().slots()));
      while (!state.mesh().alive(slot));
      const Triangle t = state.mesh().triangle(slot);
      const int kind = i % 3;
      const bool prepared = kind == 0   ? search.prepare_collapse(t[0], t[1])
                            : kind == 1 ? search.prepare_relocation(t[0])
                                        : search.prepare_flip(t[0], t[1]);
      if (!prepared) continue;
      const double before = search.energy_before(2);
      LocalSearch::Options options;
      options.power = 2;
      Fit fit;
      MeshEdit edit;
      const Point start = state.mesh().position(t[0]);
      if (!(kind == 2 ? search.evaluate(start, 2, fit) : search.fit(start, options, fit)) ||
          fit.worst > 1 || !search.finish(fit, true, edit) || !state.permits(edit)) {
        continue;
      }
      const double whole = hoppe_energy(state, width, weights).total();
      state.apply(edit);
      const double gained = hoppe_energy(state, width, weights).total() - whole;
      EXPECT_NEAR((fit.energy - before) * kEnergyLimit * kEnergyLimit / (width * width), gained,
                  1e-12);
      ++made[static_cast<std::size_t>(kind)];
    }
    for (const int count : made) EXPECT_GT(count, 10);
  }
}

TEST(HoppeEnergy, AsTheObjectiveIsLoweredWithinTheBounds) {
  const TriangleMesh mesh = bumpy(20, 30);
  const double width = bounds_of(mesh.vertices).width();
  DecimationSettings settings;
  settings.epsilon = 0.05;
  settings.objective = DecimationSettings::Objective::kHoppe;
  const BoundedDecimator decimator(mesh, mesh.vertices);
  std::size_t last = mesh.triangles.size();
  for (const double representation : {1e-6, 1e-5, 1e-4}) {
    settings.hoppe = {representation, 1e-6};
    const TriangleMesh result = decimator.run(settings).mesh;
    EXPECT_TRUE(check_mesh(result.view()).valid());
    EXPECT_TRUE(certify(mesh.vertices, result.view()).within(settings.epsilon));
    EXPECT_LT(directly(result, mesh.vertices, width, settings.hoppe).total(),
              0.8 * directly(mesh, mesh.vertices, width, settings.hoppe).total());
    // Dearer vertices, fewer of them.
    EXPECT_LT(result.triangles.size(), last);
    last = result.triangles.size();
  }
}

}  // namespace
}  // namespace emax::test
