#include <algorithm>
#include <map>

#include "testbench/cosimulation/cosimulation.h"

namespace emax {
namespace {

// The run with only the pairs that are kept. Flags and records of removed pairs pass to kept ones,
// so that the run still keeps the rules: a point's first and final pair in a block, the last pair
// of a block and of a record.
ElementRun without(const ElementRun& run, const std::vector<bool>& kept) {
  const auto records = records_of_pairs(run);
  ElementRun smaller;
  smaller.patterns = run.patterns;
  smaller.cut = run.cut;
  std::map<Word, bool> first_is_due;
  std::map<Word, std::size_t> open;  // kept pairs of the block so far, by index
  bool record_is_due = true;
  std::size_t record = 0;
  for (std::size_t i = 0; i < run.pairs.size(); ++i) {
    Pair pair = run.pairs[i];
    if (!record_is_due && records[i] != record) {
      smaller.pairs.back().next_record = true;
      record_is_due = true;
    }
    if (kept[i]) {
      if (record_is_due) smaller.records.push_back(run.records[records[i]]);
      record = records[i];
      pair.first = pair.first || first_is_due[pair.index];
      first_is_due[pair.index] = false;
      open[pair.index] = smaller.pairs.size();
      record_is_due = pair.next_record;
      smaller.pairs.push_back(pair);
    } else {
      if (pair.first) first_is_due[pair.index] = true;
      const auto same = open.find(pair.index);
      if (pair.final && same != open.end()) smaller.pairs[same->second].final = true;
      if (pair.last && !open.empty()) {
        smaller.pairs.back().final = smaller.pairs.back().last = true;
      }
    }
    if (pair.last) open.clear();
  }
  return smaller;
}

class Shrinker {
 public:
  Shrinker(const Failure& failure, const ElementFactory& make_element, std::uint32_t tries)
      : best_(failure), make_element_(make_element), tries_(tries) {}

  Failure run() {
    if (!attempt(best_.runs)) return best_;  // does not differ alone: kept as it is
    if (best_.runs.size() > 1) attempt({best_.runs.back()});
    cut_after_the_mismatch();
    keep_the_pair_alone();
    simplify_patterns();
    for (std::size_t before = 0; before != last().pairs.size();) {
      before = last().pairs.size();
      remove_pairs();
    }
    simplify_patterns();
    return best_;
  }

 private:
  ElementRun& last() { return best_.runs.back(); }

  // Takes the runs as the new best if they still differ.
  bool attempt(const std::vector<ElementRun>& runs) {
    if (tries_ == 0) return false;
    --tries_;
    if (!std::ranges::all_of(runs, is_legal) || runs.back().pairs.empty()) return false;
    const auto element = make_element_(best_.slot_bits);
    element->set_mutant(best_.mutant);
    const RunResult result = run_sequence(runs, *element);
    if (!result.mismatch) return false;
    best_.runs = runs;
    best_.mismatch = *result.mismatch;
    return true;
  }

  bool attempt_last(const ElementRun& run) {
    std::vector<ElementRun> runs = best_.runs;
    runs.back() = run;
    return attempt(runs);
  }

  void cut_after_the_mismatch() {
    if (!best_.mismatch.pair) return;
    std::vector<bool> kept(last().pairs.size(), false);
    std::fill_n(kept.begin(), *best_.mismatch.pair + 1, true);
    attempt_last(without(last(), kept));
  }

  void keep_the_pair_alone() {
    if (!best_.mismatch.pair) return;
    const std::size_t pair = *best_.mismatch.pair;
    ElementRun one;
    one.records = {last().records[records_of_pairs(last())[pair]]};
    one.pairs = {last().pairs[pair]};
    one.pairs[0].first = one.pairs[0].final = one.pairs[0].next_record = one.pairs[0].last = true;
    attempt({one});
  }

  void simplify_patterns() {
    if (last().patterns.all_willing()) return;
    ElementRun run = last();
    run.patterns = {};
    if (attempt_last(run)) return;
    for (Pattern StreamPatterns::*stream : {&StreamPatterns::record, &StreamPatterns::point,
                                            &StreamPatterns::nearest, &StreamPatterns::worst}) {
      run = last();
      if (run.patterns.*stream == Pattern::kAlways) continue;
      run.patterns.*stream = Pattern::kAlways;
      attempt_last(run);
    }
  }

  // Removes ever smaller chunks (delta debugging).
  void remove_pairs() {
    for (std::size_t chunk = last().pairs.size() / 2; chunk > 0; chunk /= 2) {
      for (std::size_t begin = 0; begin < last().pairs.size() && tries_ > 0;) {
        std::vector<bool> kept(last().pairs.size(), true);
        const std::size_t end = std::min(begin + chunk, kept.size());
        std::fill(kept.begin() + static_cast<std::ptrdiff_t>(begin),
                  kept.begin() + static_cast<std::ptrdiff_t>(end), false);
        if (!attempt_last(without(last(), kept))) begin = end;
      }
    }
  }

  Failure best_;
  const ElementFactory& make_element_;
  std::uint32_t tries_;
};

}  // namespace

Failure shrink(const Failure& failure, const ElementFactory& make_element, std::uint32_t tries) {
  return Shrinker(failure, make_element, tries).run();
}

}  // namespace emax
