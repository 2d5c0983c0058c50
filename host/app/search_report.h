#pragma once

#include <optional>

#include "host/app/certified_result.h"
#include "host/app/commands.h"
#include "host/device/device_address.h"
#include "host/optimize/optimize.h"

namespace emax {

// What a search came to, as the text and the JSON say it. What it refers to outlives it.
struct SearchOutcome {
  const OptimizeOptions& options;
  const OptimizeSettings& settings;
  const OptimizeState& state;
  std::size_t excludable;         // points
  bool feasible;                  // otherwise `shown` has the least violation
  bool is_reference;              // `shown` is the reference surface as it is
  const BestMesh& shown;          // the mesh that the report is about
  const CertifiedResult& result;  // that mesh
  double seconds;                 // that the search took
  std::optional<DeviceCounters> counters;
  std::optional<BoardModel> board;    // whose time is predicted
  std::optional<double> cpu_seconds;  // that the same work took on this processor
};

// ", 3 failed (crashed); last: ...", or nothing.
std::string describe_failures(const OptimizeState& state);

void print(const SearchOutcome& outcome);

// What goes to --json.
ResultReport report_of(const SearchOutcome& outcome);

}  // namespace emax
