#pragma once

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/decimation_passes.h"

namespace emax {

struct ScheduledMesh {
  TriangleMesh mesh;         // keeps every limit
  bool complete = false;     // the settings' `interrupted` did not end the passes
  std::size_t expected = 0;  // DecimatedMesh::expected
};

// Runs the passes over the mesh in the order that the settings' objective and effort ask for, and
// reports their progress. With Effort::kDeep the passes go on until nothing is gained.
ScheduledMesh run_passes(DecimationState& state, DecimationPasses::Options options,
                         const DecimationSettings& settings);

}  // namespace emax
