#pragma once

#include <optional>
#include <utility>

#include <emax/genocop.h>
#include "host/measure/error_constraint.h"
#include "host/optimize/reduction_walk.h"
#include "host/run_log/run_log.h"

namespace emax {

// What one evaluation of a search came to.
struct SearchResult {
  LoggedEvaluation evaluation;
  TriangleMesh mesh;  // of one that was made here and may be the best
  MeasuredError error;

  bool failed() const { return !evaluation.failure.empty(); }
  bool feasible() const { return !failed() && evaluation.violation() <= 0; }
};

// A candidate that a worker has.
struct CandidateInWork {
  Genes genes;
  std::uint64_t rival = 0;            // triangles to beat, for its decimation; 0: none
  double worked = 0;                  // seconds of its trials
  std::optional<ReductionWalk> walk;  // where the evaluation looks for a gene's best value
  std::optional<SearchResult> best;   // of its trials

  // What a trial of the walk came to. False while the walk goes on; then `result` is gone.
  // Otherwise it becomes that of the evaluation: the trial of the fewest triangles that holds, or
  // the first.
  bool walk_on(SearchResult& result) {
    const LoggedEvaluation& e = result.evaluation;
    result.evaluation.walked = walk->next();
    walk->told(!result.failed(), e.triangles, e.violation());
    const bool better = !best || (result.feasible() &&
                                  (!best->feasible() || e.triangles < best->evaluation.triangles));
    if (better) best = std::move(result);
    if (walk->next()) return false;
    result = std::move(*best);
    return true;
  }
};

}  // namespace emax
