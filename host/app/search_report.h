#pragma once

#include <optional>
#include <vector>

#include "host/app/certified_result.h"
#include "host/app/commands.h"
#include "host/app/facts.h"
#include "host/device/device_address.h"
#include "host/optimize/optimize.h"

namespace emax {

// The result of a search for the text and the JSON. The members that are references must outlive
// it.
struct SearchOutcome {
  const OptimizeOptions& options;
  const OptimizeSettings& settings;
  const OptimizeState& state;
  std::size_t excludable;         // points
  bool feasible;                  // false: `shown` has the least violation
  bool is_reference;              // `shown` is the unchanged reference surface
  const BestMesh& shown;          // the mesh that the report is about
  const CertifiedResult& result;  // that mesh
  const PlaneParts& planes;       // of its regions
  double seconds;                 // time of the search
  std::optional<DeviceCounters> counters;
  std::optional<BoardModel> board;    // the board whose time is predicted
  std::optional<double> cpu_seconds;  // time of the same work on this processor
};

// ", 3 failed (crashed); last: ...", or nothing.
std::string describe_failures(const OptimizeState& state);

void print(Facts& facts, const SearchOutcome& outcome);

// The evaluations of a run's log, in the order of their candidates, those of the end last.
std::vector<ReportEvaluation> evaluations_of(const RunLog& log);

// The content of --json.
ResultReport report_of(const SearchOutcome& outcome);

}  // namespace emax
