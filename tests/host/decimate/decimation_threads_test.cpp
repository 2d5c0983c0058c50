#include <gtest/gtest.h>

#include <algorithm>

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/decimation_passes.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

struct Outcome {
  std::vector<std::size_t> edits;
  TriangleMesh mesh;
};

// Every pass whose edits several threads propose.
Outcome run_passes(std::size_t threads) {
  const TriangleMesh mesh = bumpy(40, 60);
  DecimationState::Guards guards;
  guards.threads = threads;
  DecimationState state(mesh, mesh.vertices, nullptr, 0.02 * 0.02, guards);
  DecimationPasses passes(state, {}, threads, nullptr);
  Outcome outcome;
  outcome.edits = {passes.sweep(), passes.collapse()};
  for (const auto steps : {LocalSearch::Steps::kReweighted, LocalSearch::Steps::kNewton}) {
    passes.use(steps);
    for (const std::size_t edits : {passes.flip(8), passes.relocate(8)}) {
      outcome.edits.push_back(edits);
    }
  }
  state.reassign();
  outcome.edits.push_back(passes.collapse_and_mend());
  outcome.mesh = state.mesh().compact();
  return outcome;
}

TEST(DecimationThreads, ChangeNoEditOfAnyPass) {
  const Outcome one = run_passes(1);
  EXPECT_GT(std::ranges::min(one.edits), 0u);
  for (const std::size_t threads : {2, 5}) {
    const Outcome several = run_passes(threads);
    EXPECT_EQ(several.edits, one.edits);
    EXPECT_TRUE(same_bytes(several.mesh, one.mesh));
  }
}

TEST(DecimationThreads, ChangeNoByteOfADecimation) {
  const TriangleMesh mesh = bumpy(30, 45);
  DecimationSettings settings;
  settings.epsilon = 0.02;
  for (const auto effort :
       {DecimationSettings::Effort::kRelax, DecimationSettings::Effort::kDeep}) {
    settings.effort = effort;
    settings.threads = 1;
    const TriangleMesh one = BoundedDecimator(mesh, mesh.vertices).run(settings).mesh;
    settings.threads = 3;
    EXPECT_TRUE(same_bytes(BoundedDecimator(mesh, mesh.vertices).run(settings).mesh, one));
  }
}

}  // namespace
}  // namespace emax::test
