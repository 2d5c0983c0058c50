#include "host/chain/decimator_run.h"

// Nothing but the registry's table, so that a test can link a table of its own in its place.
namespace emax {

std::span<const DecimatorRun> decimator_runs() {
  static const std::vector<DecimatorRun> all = decimator_runs_of(Decimators{});
  return all;
}

}  // namespace emax
