#include "host/decimate/race.h"

#include <gtest/gtest.h>

#include <utility>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_validity.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kEpsilon = 0.02;

TEST(Race, IsLostOnceAndForAll) {
  Race race(1000);
  EXPECT_FALSE(race.lost(Race::At::kExchanged, 1100));
  EXPECT_EQ(race.expected(), 0u);
  EXPECT_TRUE(race.lost(Race::At::kExchanged, 1200));
  const std::size_t expected = race.expected();
  EXPECT_GT(expected, 1000u);
  EXPECT_LE(expected, 1200u);
  EXPECT_TRUE(race.lost(Race::At::kRestored, 10));
  EXPECT_TRUE(race.lost());
  EXPECT_EQ(race.expected(), expected);
  EXPECT_FALSE(Race(0).lost(Race::At::kExchanged, 1'000'000));
}

class RaceTest : public testing::Test {
 protected:
  explicit RaceTest(TriangleMesh surface = bumpy(40, 64)) : surface_(std::move(surface)) {}

  DecimatedMesh against(std::size_t rival, DecimationSettings::Effort effort) const {
    DecimationSettings settings;
    settings.epsilon = kEpsilon;
    settings.effort = effort;
    settings.rival = rival;
    return BoundedDecimator(surface_, surface_.vertices).run(settings);
  }
  // Nothing here is of the decimator's own.
  void expect_within(const TriangleMesh& mesh) const {
    EXPECT_TRUE(check_mesh(mesh.view()).valid());
    EXPECT_TRUE(certify(surface_.vertices, mesh.view()).within(kEpsilon));
    const ExactMesh exact(mesh.view()), reference(surface_.view());
    EXPECT_TRUE(decided_distance(mesh.view(), reference, kEpsilon).within(kEpsilon));
    EXPECT_TRUE(decided_distance(surface_.view(), exact, kEpsilon).within(kEpsilon));
  }

  const TriangleMesh surface_;
};

// The twin is the whole work, which would have had no fewer triangles than the rival.
TEST_F(RaceTest, IsLostOnlyAgainstWhatTheWholeWorkDoesNotBeat) {
  for (const auto effort :
       {DecimationSettings::Effort::kRelax, DecimationSettings::Effort::kDeep}) {
    const DecimatedMesh whole = against(0, effort);
    EXPECT_EQ(whole.expected, 0u);
    const std::size_t fewest = whole.mesh.triangles.size();
    // Lost after collapses, after the exchanges, later and never.
    for (const double share : {0.45, 0.85, 1.01}) {
      const auto rival = static_cast<std::size_t>(share * static_cast<double>(fewest));
      SCOPED_TRACE(testing::Message() << rival << " against " << fewest);
      const DecimatedMesh result = against(rival, effort);
      EXPECT_FALSE(result.interrupted);
      EXPECT_TRUE(result.expected > 0 || share > 0.45);
      if (result.expected == 0) {
        EXPECT_TRUE(same_bytes(result.mesh, whole.mesh));
        continue;
      }
      EXPECT_GE(fewest, rival);
      EXPECT_GT(result.expected, rival);
      EXPECT_NEAR(static_cast<double>(result.expected), static_cast<double>(fewest),
                  0.25 * static_cast<double>(fewest));
      expect_within(result.mesh);
    }
  }
}

class RaceFault : public RaceTest {
 protected:
  RaceFault() : RaceTest(bumpy(24, 40)) {}
};

TEST_F(RaceFault, IsCaught) {
  constexpr auto kEffort = DecimationSettings::Effort::kRelax;
  const std::size_t beaten = against(0, kEffort).mesh.triangles.size() + 2;
  EXPECT_EQ(against(beaten, kEffort).expected, 0u);
  const DeliberateFault broken(Fault::kGivesUpEarly);
  EXPECT_GT(against(beaten, kEffort).expected, 0u);
}

}  // namespace
}  // namespace emax::test
