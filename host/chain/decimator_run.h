#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "host/chain/bounded_chain.h"
#include "host/parameters/registry.h"

namespace emax {

// What runs a decimator.
struct DecimatorRun {
  std::string_view name;
  DecimatedMesh (*run)(const TriangleMesh& start, const ParameterValues& values,
                       const BoundedStage& stage, const RunOptions& options);
};

template <typename Decimator>
DecimatedMesh run_decimator(const TriangleMesh& start, const ParameterValues& values,
                            const BoundedStage& stage, const RunOptions& options) {
  if constexpr (Decimator::kBounded) {
    return Decimator::run(start, values, stage, options);
  } else {
    return {Decimator::run(start, values), {}, false, 0};
  }
}

template <typename... Decimator>
std::vector<DecimatorRun> decimator_runs_of(TypeList<Decimator...>) {
  return {{Decimator::kName, &run_decimator<Decimator>}...};
}

// Of decimators().
std::span<const DecimatorRun> decimator_runs();

}  // namespace emax
