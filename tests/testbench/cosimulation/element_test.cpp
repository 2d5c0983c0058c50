#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "sw_model/base/error.h"
#include "testbench/cosimulation/cosimulation.h"
#include "testbench/element/verilated_variants.h"
#include "testbench/verilator/verilator_messages.h"

namespace emax {
namespace {

const ElementTest& test_named(const std::string& name) {
  for (const ElementTest& test : element_tests()) {
    if (test.name == name) return test;
  }
  throw std::out_of_range(name);
}

ElementRun first_run(const std::string& test) {
  Random random(1);
  return test_named(test).make(0, random).back();
}

std::string text_of(const ElementRun& run) {
  std::ostringstream out;
  write_run(out, run);
  return out.str();
}

bool equal(const ElementOutputs& a, const ElementOutputs& b) {
  return a.record_ready == b.record_ready && a.pair_ready == b.pair_ready &&
         a.nearest_valid == b.nearest_valid && a.nearest_last == b.nearest_last &&
         a.worst_valid == b.worst_valid && a.nearest == b.nearest &&
         a.worst_squared == b.worst_squared && a.worst_index == b.worst_index;
}

// In every cycle all combinations of valid and ready are shown to the element: without a clock edge
// no output may move.
TEST(Element, HasNoPathFromAnInputToAnOutputWithinACycle) {
  const auto element = make_plain_element(kDeviceSlotBits);
  Random random(7);
  const RecordWords record = {};
  const Pair pair = {{}, 5, true, true, true, true};
  std::uint64_t moved = 0, nearest = 0, stalled = 0;
  for (int cycle = 0; cycle < 3000; ++cycle) {
    const ElementOutputs before = element->outputs();
    nearest += before.nearest_valid ? 1 : 0;
    stalled += before.pair_ready ? 0 : 1;
    const auto show = [&](std::uint32_t inputs) {
      element->offer_record((inputs & 1) != 0 ? &record : nullptr);
      element->offer_pair((inputs & 2) != 0 ? &pair : nullptr);
      element->set_ready((inputs & 4) != 0, (inputs & 8) != 0);
    };
    for (std::uint32_t inputs = 0; inputs < 16; ++inputs) {
      show(inputs);
      element->settle();
      if (!equal(before, element->outputs())) ++moved;
    }
    show(random.below(16));
    element->clock(cycle == 0);
  }
  EXPECT_EQ(moved, 0u);
  EXPECT_GT(nearest, 500u);
  EXPECT_GT(stalled, 500u);
  EXPECT_FALSE(element->assertion_failed());
}

// Two pairs of one point, `distance` cycles apart; true when the design's assertion speaks.
bool asserts_at(std::uint32_t distance, bool later_is_first) {
  const auto element = make_plain_element(kDeviceSlotBits);
  const RecordWords record = {};
  element->set_ready(true, true);
  element->offer_pair(nullptr);
  element->clock(true);
  element->offer_record(&record);
  element->clock();
  for (int i = 0; i < 8 && !element->outputs().pair_ready; ++i) element->clock();
  element->offer_record(nullptr);
  for (std::uint32_t i = 0; i <= distance; ++i) {
    const bool later = i == distance;
    const Pair pair = {{}, later ? 0 : i, !later || later_is_first, true, false, false};
    element->offer_pair(&pair);
    EXPECT_TRUE(element->outputs().pair_ready);
    element->clock();
  }
  return element->assertion_failed();
}

TEST(Element, AssertsTheDistanceOfAPointsPairs) {
  EXPECT_FALSE(asserts_at(kReadModifyWrite, false));
  for (std::uint32_t distance = 1; distance < kReadModifyWrite; ++distance) {
    EXPECT_TRUE(asserts_at(distance, false)) << distance;
    EXPECT_FALSE(asserts_at(distance, true)) << distance;
  }
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// Of twelve elements that break a contract in each of many cycles, three lines; the program's end
// tells of the others.
TEST(Element, PrintsOnlyTheFirstMessagesOfAssertions) {
  const auto break_contracts = [] {
    for (int i = 0; i < 12; ++i) asserts_at(1, false);
  };
  const unsigned long before = emax_verilator_errors();
  testing::internal::CaptureStdout();
  break_contracts();
  const std::string output = testing::internal::GetCapturedStdout();
  const unsigned long shown = before < kShownErrors ? kShownErrors - before : 0;
  EXPECT_EQ(count_of(output, "%Error"), shown) << output;
  EXPECT_EQ(count_of(output, "follow each other too closely"), shown) << output;
  EXPECT_GE(emax_verilator_errors(), before + 12);
  EXPECT_EQ(count_of(output, "$stop"), 0u) << output;
  EXPECT_EXIT(
      {
        break_contracts();
        std::exit(0);
      },
      testing::ExitedWithCode(0), "[0-9]+ more %Error lines of the simulated hardware");
}

TEST(Driver, AcceptsOnePairACycle) {
  const auto element = make_plain_element(kPairsSlotBits);
  const ElementRun run = first_run("pairs: bumpy sphere");
  ASSERT_TRUE(run.patterns.all_willing());
  const RunResult result = drive(*element, run, expected_of(run));
  EXPECT_FALSE(result.mismatch) << result.mismatch->what;
  EXPECT_EQ(result.pairs, run.pairs.size());
  EXPECT_EQ(result.accepting_cycles, run.pairs.size());
}

TEST(Driver, SeesEveryWrongWord) {
  const auto element = make_plain_element(kPairsSlotBits);
  const ElementRun run = first_run("blocks: of a few points");
  const Expected right = expected_of(run);
  EXPECT_FALSE(drive(*element, run, right).mismatch);
  const auto mismatch_of = [&](const Expected& wrong) {
    const RunResult result = drive(*element, run, wrong);
    EXPECT_TRUE(result.mismatch);
    return result.mismatch.value_or(Mismatch{});
  };
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    Expected wrong = right;
    const std::size_t at = random.below(right.nearest.size());
    wrong.nearest[at].squared ^= 1u << random.below(32);
    EXPECT_EQ(mismatch_of(wrong).sample, at);
    EXPECT_EQ(mismatch_of(wrong).pair, right.nearest[at].pair);
    wrong = right;
    wrong.nearest[at].last = !wrong.nearest[at].last;
    EXPECT_EQ(mismatch_of(wrong).sample, at);
    wrong = right;
    const std::size_t block = random.below(right.worst.size());
    wrong.worst[block].index ^= 1u << random.below(kPointBits);
    EXPECT_EQ(mismatch_of(wrong).stream, "m_axis_worst");
    wrong = right;
    wrong.worst[block].squared ^= 1u;
    EXPECT_EQ(mismatch_of(wrong).sample, block);
  }
  Expected longer = right, shorter = right;
  longer.nearest.push_back(right.nearest.back());
  EXPECT_NE(mismatch_of(longer).what.find("no word"), std::string::npos);
  shorter.nearest.pop_back();
  EXPECT_NE(mismatch_of(shorter).what.find("too many"), std::string::npos);
}

TEST(Runs, AreReadAsTheyWereWritten) {
  for (const ElementTest& test : element_tests()) {
    Random random(11);
    for (const ElementRun& run : test.make(3, random)) {
      std::istringstream in(text_of(run));
      EXPECT_EQ(text_of(read_run(in)), text_of(run)) << test.name;
    }
  }
  for (const char* wrong : {"pair 0 0 0\nend\n", "bird\nend\n", "record 1\nend\n", "cut 1\n",
                            "patterns always never always always 1\nend\n",
                            "pair 0 0 0 0 fF-l\nend\n", "pair 0 0 0 123456789 fFnl\nend\n"}) {
    std::istringstream in(wrong);
    EXPECT_THROW(read_run(in), Error) << wrong;
  }
}

TEST(Runs, KeepTheRulesOfTheStreams) {
  ElementRun run;
  const std::vector<RecordWords> records(3);
  for (std::size_t points = 1; points < 7; ++points) {
    append_block(run, std::vector<std::array<Word, 3>>(points), records);
    EXPECT_TRUE(is_legal(run)) << points;
  }
  ElementRun wrong = run;
  wrong.records.pop_back();
  EXPECT_FALSE(is_legal(wrong));
  wrong = run;
  wrong.pairs[0].first = false;
  EXPECT_FALSE(is_legal(wrong));
  wrong = run;
  wrong.pairs[0].last = true;
  EXPECT_FALSE(is_legal(wrong));
  wrong = run;
  wrong.pairs[4].index = wrong.pairs[3].index;
  EXPECT_FALSE(is_legal(wrong));
}

TEST(Runs, OfOneSeedAreEqual) {
  for (const ElementTest& test : element_tests()) {
    Random one(5), same(5), other(6);
    const std::string text = text_of(test.make(2, one).back());
    EXPECT_EQ(text_of(test.make(2, same).back()), text) << test.name;
    EXPECT_NE(text_of(test.make(2, other).back()), text) << test.name;
  }
  EXPECT_NE(named_seed("a", 1), named_seed("b", 1));
  EXPECT_NE(named_seed("a", 1), named_seed("a", 2));
}

TEST(Runs, CrossEveryIdleWithEveryBackPressure) {
  std::set<std::pair<Pattern, Pattern>> points, records;
  Random random(1);
  for (std::uint64_t i = 0; i < 49; ++i) {
    const StreamPatterns p =
        test_named("streams: idles and back-pressure").make(i, random)[0].patterns;
    points.insert({p.point, p.nearest});
    records.insert({p.record, p.worst});
  }
  EXPECT_EQ(points.size(), std::size_t{kPatterns} * kPatterns);
  EXPECT_EQ(records.size(), std::size_t{kPatterns} * kPatterns);
}

}  // namespace
}  // namespace emax
