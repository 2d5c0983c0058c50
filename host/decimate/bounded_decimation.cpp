#include "host/decimate/bounded_decimation.h"

#include <chrono>
#include <cstdio>
#include <memory>

#include "host/decimate/decimation_passes.h"

namespace emax {

BoundedDecimation decimate_bounded(const TriangleMesh& mesh, std::span<const Point> cloud,
                                   const BoundedDecimationSettings& settings,
                                   const TriangleMesh* reference) {
  const auto start = std::chrono::steady_clock::now();
  const double limit = settings.epsilon * (1 - 1e-9);
  std::unique_ptr<BackBound> back;
  if (settings.two_sided) {
    const double back_limit = settings.epsilon_back > 0 ? settings.epsilon_back : settings.epsilon;
    back = std::make_unique<BackBound>(reference == nullptr ? mesh : *reference,
                                       back_limit * (1 - 1e-9));
  }
  DecimationState state(mesh, cloud, back.get(), limit * limit, {});
  DecimationPasses passes(state, settings.interrupted);
  const auto say = [&](const char* what, std::size_t count) {
    if (!settings.verbose) return;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%7.2f s %-10s %7zu -> %zu triangles\n", seconds, what, count,
                state.mesh().triangles());
    std::fflush(stdout);
  };
  say("begin", 0);
  say("collapse", passes.collapse());
  if (settings.effort >= 1) {
    for (int round = 0; round < (settings.effort >= 2 ? 1 : 1) && !passes.stopped(); ++round) {
      state.reassign();
      say("relocate", passes.relocate(4));
      say("flip", passes.flip(4));
      say("relocate", passes.relocate(4));
      const std::size_t before = state.mesh().triangles();
      say("collapse", passes.collapse());
      if (1000 * state.mesh().triangles() > 995 * before) break;
    }
  }
  if (settings.effort >= 2) {
    for (int round = 0; round < (getenv("R")?atoi(getenv("R")):6) && !passes.stopped(); ++round) {
      state.reassign();
      const std::size_t done = passes.collapse_and_mend(getenv("W")?atof(getenv("W")):2.5);
      say("deep", done);
      if (done == 0) break;
      say("flip", passes.flip(4));
      say("relocate", passes.relocate(4));
      say("collapse", passes.collapse());
    }
  }
  return {state.mesh().compact(), {}};
}

}  // namespace emax
