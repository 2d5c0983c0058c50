#include "host/genocop/look_ahead_scheduler.h"

#include <fmt/format.h>

#include <stdexcept>

namespace emax {

std::optional<Candidate> LookAheadScheduler::next() {
  while (search_.asked() < budget_) {
    const std::uint64_t index = search_.asked();
    const std::uint64_t look_ahead = search_.settings().look_ahead;
    const std::uint64_t known = index < look_ahead ? 0 : index - look_ahead + 1;
    tell_up_to(known);
    if (search_.told() < known) return std::nullopt;
    Candidate candidate = search_.ask();
    out_.try_emplace(candidate.index);
    if (candidate.known) {
      out_[candidate.index] = results_[candidate.index] = *candidate.known;
    } else if (candidate.same_as) {
      repeats_[candidate.index] = *candidate.same_as;
    } else {
      return candidate;
    }
  }
  tell_up_to(budget_);
  return std::nullopt;
}

void LookAheadScheduler::complete(std::uint64_t index, const Evaluation& evaluation) {
  const auto found = out_.find(index);
  if (found == out_.end() || found->second || repeats_.contains(index)) {
    throw std::logic_error(fmt::format("candidate {} is not out", index));
  }
  found->second = evaluation;
  results_[index] = evaluation;
  if (search_.asked() == budget_) tell_up_to(budget_);
}

void LookAheadScheduler::tell_up_to(std::uint64_t count) {
  while (search_.told() < count && search_.told() < search_.asked()) {
    const std::uint64_t index = search_.told();
    std::optional<Evaluation>& evaluation = out_.at(index);
    if (const auto repeat = repeats_.find(index); repeat != repeats_.end()) {
      evaluation = results_.at(repeat->second);  // an earlier index, so it was told before
    }
    if (!evaluation) return;
    search_.tell(index, *evaluation);
    out_.erase(index);
  }
}

}  // namespace emax
