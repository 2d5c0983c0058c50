#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "host/genocop/genocop.h"

namespace emax {

// Connects Genocop with workers that finish in any order. It holds results back until the candidate
// that may depend on them is due, so the candidates are the same for any number of workers. At most
// K candidates are out at one time, so K should be at least the number of workers. In addition to
// ask() and tell() a call takes O(log evaluations).
class LookAheadScheduler {
 public:
  LookAheadScheduler(Genocop& search, std::uint64_t budget) : search_(search), budget_(budget) {}

  // The next candidate to evaluate. Nothing while a result must come first, or when the budget is
  // spent. A repeated candidate is charged and answered here; it is not handed out.
  std::optional<Candidate> next();
  // Throws std::logic_error for an index that is not out.
  void complete(std::uint64_t index, const Evaluation& evaluation);

  bool finished() const { return search_.asked() == budget_ && search_.told() == budget_; }

 private:
  void tell_up_to(std::uint64_t count);

  Genocop& search_;
  std::uint64_t budget_;
  std::map<std::uint64_t, std::optional<Evaluation>> out_;  // asked, not told; empty: in work
  std::map<std::uint64_t, std::uint64_t> repeats_;          // index -> the one it repeats
  std::map<std::uint64_t, Evaluation> results_;             // all results so far
};

}  // namespace emax
