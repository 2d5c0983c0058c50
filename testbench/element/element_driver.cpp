#include "testbench/element/element_driver.h"

#include "sw_model/base/float_bits.h"

namespace emax {
namespace {

// Cycles without any handshake until the element counts as hung: stalls of all four streams in a
// row and several times the depth of the pipeline.
constexpr std::uint64_t kPatience = 4 * kLongestStall + 1000;
// Cycles after the last expected word in which an additional word would be seen.
constexpr std::uint64_t kAftermath = 12;

std::string differing(const char* name, Word expected, Word actual) {
  return std::string(name) + ": model " + describe_bits(expected) + ", element " +
         describe_bits(actual);
}

class Scoreboard {
 public:
  Scoreboard(const Expected& expected, RunResult& result) : expected_(expected), result_(result) {}

  bool complete() const {
    return result_.nearest == expected_.nearest.size() && result_.worst == expected_.worst.size();
  }

  void take_nearest(const ElementOutputs& o) {
    const std::uint64_t sample = result_.nearest;
    if (sample >= expected_.nearest.size()) {
      return differ("m_axis_nearest", sample, {}, "a word too many: " + describe_bits(o.nearest));
    }
    const ExpectedNearest& e = expected_.nearest[sample];
    if (e.squared != o.nearest) {
      differ("m_axis_nearest", sample, e.pair, differing("squared distance", e.squared, o.nearest));
    } else if (e.last != o.nearest_last) {
      differ("m_axis_nearest", sample, e.pair,
             e.last ? "tlast is missing" : "tlast where the block goes on");
    }
    ++result_.nearest;
  }

  void take_worst(const ElementOutputs& o) {
    const std::uint64_t sample = result_.worst;
    if (sample >= expected_.worst.size()) {
      return differ("m_axis_worst", sample, {},
                    "a beat too many: " + describe_bits(o.worst_squared));
    }
    const ExpectedWorst& e = expected_.worst[sample];
    if (e.squared != o.worst_squared) {
      differ("m_axis_worst", sample, e.pair,
             differing("squared distance", e.squared, o.worst_squared));
    } else if (e.index != o.worst_index) {
      differ(
          "m_axis_worst", sample, e.pair,
          "index: model " + std::to_string(e.index) + ", element " + std::to_string(o.worst_index));
    }
    ++result_.worst;
  }

  // A beat that was not taken must still be there, unchanged.
  void check_held(const ElementOutputs& before, const ElementOutputs& now, bool nearest_taken,
                  bool worst_taken) {
    if (before.nearest_valid && !nearest_taken &&
        (!now.nearest_valid || now.nearest != before.nearest ||
         now.nearest_last != before.nearest_last)) {
      differ("m_axis_nearest", result_.nearest, {}, "a waiting beat changed");
    }
    if (before.worst_valid && !worst_taken &&
        (!now.worst_valid || now.worst_squared != before.worst_squared ||
         now.worst_index != before.worst_index)) {
      differ("m_axis_worst", result_.worst, {}, "a waiting beat changed");
    }
  }

  void nothing_comes() {
    if (result_.nearest < expected_.nearest.size()) {
      const ExpectedNearest& e = expected_.nearest[result_.nearest];
      differ("m_axis_nearest", result_.nearest, e.pair,
             "squared distance: model " + describe_bits(e.squared) + ", element gives no word");
    } else if (result_.worst < expected_.worst.size()) {
      const ExpectedWorst& e = expected_.worst[result_.worst];
      differ("m_axis_worst", result_.worst, e.pair,
             "squared distance: model " + describe_bits(e.squared) + ", element gives no beat");
    } else {
      differ("s_axis_point", result_.pairs, {}, "pairs are not accepted any more");
    }
  }

  void differ(const char* stream, std::uint64_t sample, std::optional<std::size_t> pair,
              const std::string& what) {
    if (result_.mismatch) return;
    result_.mismatch = Mismatch{stream, sample, pair, result_.cycles, what};
  }

 private:
  const Expected& expected_;
  RunResult& result_;
};

}  // namespace

RunResult drive(ElementSimulation& element, const ElementRun& run, const Expected& expected,
                RunObserver* observer) {
  RunResult result;
  Scoreboard scoreboard(expected, result);
  const StreamPatterns& p = run.patterns;
  PatternSource record_pattern(p.record, p.seed), point_pattern(p.point, p.seed + 1);
  PatternSource nearest_pattern(p.nearest, p.seed + 2), worst_pattern(p.worst, p.seed + 3);

  element.offer_record(nullptr);
  element.offer_pair(nullptr);
  element.set_ready(false, false);
  element.clock(true);

  std::size_t records_sent = 0;
  bool record_offered = false, pair_offered = false;
  std::uint64_t first_accepted = 0, quiet = 0, aftermath = 0;
  ElementOutputs now = element.outputs();
  while (!result.mismatch && aftermath < kAftermath && result.cycles != run.cut) {
    if (!record_offered && record_pattern.next() && records_sent < run.records.size()) {
      element.offer_record(&run.records[records_sent]);
      record_offered = true;
    }
    if (!pair_offered && point_pattern.next() && result.pairs < run.pairs.size()) {
      element.offer_pair(&run.pairs[result.pairs]);
      pair_offered = true;
    }
    const bool nearest_ready = nearest_pattern.next(), worst_ready = worst_pattern.next();
    element.set_ready(nearest_ready, worst_ready);

    const bool record_taken = record_offered && now.record_ready;
    const bool pair_taken = pair_offered && now.pair_ready;
    const bool nearest_taken = nearest_ready && now.nearest_valid;
    const bool worst_taken = worst_ready && now.worst_valid;
    element.clock();

    const ElementOutputs before = now;
    now = element.outputs();
    scoreboard.check_held(before, now, nearest_taken, worst_taken);
    if (nearest_taken) scoreboard.take_nearest(before);
    if (worst_taken) scoreboard.take_worst(before);
    if (record_taken) {
      ++records_sent;
      record_offered = false;
      element.offer_record(nullptr);
    }
    if (pair_taken) {
      if (result.pairs == 0) first_accepted = result.cycles;
      result.accepting_cycles = result.cycles - first_accepted + 1;
      if (observer != nullptr) observer->pair_accepted(result.pairs, result.cycles);
      ++result.pairs;
      pair_offered = false;
      element.offer_pair(nullptr);
    }
    if (observer != nullptr) observer->cycle_ended(result.cycles);
    // Output after a broken contract means nothing, and may never end.
    if (element.assertion_failed()) {
      scoreboard.differ("assertion", 0, {}, "an assertion of the design failed");
    }
    ++result.cycles;

    if (result.pairs == run.pairs.size() && scoreboard.complete()) ++aftermath;
    quiet = record_taken || pair_taken || nearest_taken || worst_taken ? 0 : quiet + 1;
    if (quiet > kPatience && aftermath == 0) scoreboard.nothing_comes();
  }
  return result;
}

}  // namespace emax
