#pragma once

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/decimation_passes.h"

namespace emax {

// Runs the passes over the mesh in the order that the settings' objective and effort ask for, and
// reports their progress. Returns false where the settings' `interrupted` ended them; the mesh is
// then the one reached so far. With Effort::kDeep the passes go on until nothing is gained.
bool run_passes(DecimationState& state, DecimationPasses::Options options,
                const DecimationSettings& settings);

}  // namespace emax
