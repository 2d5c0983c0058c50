#pragma once

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/decimation_passes.h"

namespace emax {

// Runs the passes over the mesh in the order that the settings' objective and effort ask for, and
// tells their progress. False where the settings' `interrupted` ended them; the mesh is then what
// was reached. The time is the passes' own; with Effort::kDeep they go on until nothing is gained.
bool run_passes(DecimationState& state, DecimationPasses::Options options,
                const DecimationSettings& settings);

}  // namespace emax
