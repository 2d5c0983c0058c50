#include "host/reconstruct/reconstruction.h"

// Nothing but the registry's table, so that a test can link a table of its own in its place.
namespace emax {

std::span<const MethodRun> method_runs() {
  static const std::vector<MethodRun> all = runs_of(ReconstructionMethods{});
  return all;
}

}  // namespace emax
