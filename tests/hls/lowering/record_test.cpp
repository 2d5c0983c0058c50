// The record of a function of one's own: which inputs come from the memory, what is refused, and
// that the kernel's own record comes out of it.
#include <gtest/gtest.h>

#include <stdexcept>

#include "hls/lowering/function_subject.h"
#include "hls/lowering/opencl.h"
#include "hls/lowering/systemverilog.h"
#include "hls/lowering/testbench_text.h"
#include "testbench/lowered/bench_samples.h"
#include "testbench/lowered/graph_checks.h"
#include "testbench/lowered/graph_mutants.h"
#include "tests/hls/lowering/functions/fixed_distance.h"
#include "tests/hls/lowering/functions/scaled_in_range.h"
#include "tests/hls/lowering/module_text.h"

namespace emax {
namespace {

constexpr const char* kScaledHeader =
    EMAX_PROJECT "/tests/hls/lowering/functions/scaled_in_range.h";
constexpr const char* kDistanceHeader =
    EMAX_PROJECT "/tests/hls/lowering/functions/fixed_distance.h";

LoweredDesign scaled(const std::vector<std::string>& record) {
  LoweringOptions options;
  options.record = record;
  return EMAX_FUNCTION(scaled_in_range, kScaledHeader).lower(options);
}

std::vector<std::string> names_from_memory(const LoweredDesign& design) {
  std::vector<std::string> names;
  for (const Input& input : design.graph.inputs()) {
    if (input.arrival == Arrival::kMemory) {
      names.push_back(input.name + " " + std::to_string(input.record_bit));
    }
  }
  return names;
}

TEST(Record, HasTheFieldsOfItsParametersWithoutGaps) {
  EXPECT_EQ(
      names_from_memory(scaled({"gain", "range"})),
      (std::vector<std::string>{"range_is_open 0", "range_from 1", "range_to 33", "gain 65"}));
  EXPECT_EQ(scaled({"range", "gain"}).about.record_bits, 97);
  EXPECT_EQ(unit_module(scaled({"range", "gain"})), unit_module(scaled({"gain", "range"})));
  EXPECT_TRUE(names_from_memory(scaled({})).empty());
}

std::string refusal(const std::vector<std::string>& record) {
  try {
    scaled(record);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Record, RefusesOtherParametersAndAll) {
  EXPECT_EQ(refusal({"range", "offset"}),
            "--record: no parameter is called 'offset'; scaled_in_range has the parameters range, "
            "x, always, gain");
  EXPECT_EQ(refusal({"range_from"}).find("--record: no parameter is called 'range_from'"), 0u);
  EXPECT_EQ(refusal({"gain", "gain"}), "--record names gain twice; once is enough");
  EXPECT_EQ(refusal({"range", "x", "always", "gain"}),
            "--record has every parameter, so that nothing meets the record; leave one out of "
            "range, x, always, gain");
  LoweringOptions options;
  options.record = {"t"};
  EXPECT_THROW(lower(Form::kVisibleEdge, options), std::invalid_argument);
  EXPECT_THROW(unit_module(scaled({})), std::invalid_argument);
  EXPECT_THROW(unit_testbench_source(scaled({})), std::invalid_argument);
}

// Fields are read in the cycle that needs them: with a record fewer bits wait.
TEST(Record, WaitsInItsMemory) {
  const LoweredDesign with = scaled({"range", "gain"}), without = scaled({});
  EXPECT_LT(with.schedule.delay_bits, without.schedule.delay_bits);
  EXPECT_EQ(with.schedule.latency, without.schedule.latency);
  EXPECT_GT(with.last_read(), 20);
}

TEST(Record, UnitHasLegalNamesAndOneDriverASignal) {
  const std::vector<std::vector<std::string>> records = {
      {"range", "gain"}, {"always"}, {"x"}, {"x", "range", "always"}};
  for (const std::vector<std::string>& record : records) {
    EXPECT_EQ(test::fault_of_module(unit_module(scaled(record))), "");
  }
}

// The kernel's distance as a function of one's own has the schedule of the kernel's form, field by
// field.
TEST(Record, OfTheKernelsDistanceIsTheKernelsOwn) {
  LoweringOptions options;
  options.record = {"t"};
  const LoweredDesign own = EMAX_FUNCTION(fixed_distance, kDistanceHeader).lower(options);
  const LoweredDesign& kernel = emax_distance_design();
  EXPECT_EQ(own.schedule.latency, kernel.schedule.latency);
  EXPECT_EQ(own.last_read(), kernel.last_read());
  EXPECT_EQ(own.schedule.delay_bits, kernel.schedule.delay_bits);
  ASSERT_EQ(own.graph.inputs().size(), kernel.graph.inputs().size());
  for (std::size_t i = 0; i < own.graph.inputs().size(); ++i) {
    const Input& mine = own.graph.inputs()[i];
    const Input& form = kernel.graph.inputs()[i];
    EXPECT_EQ(mine.arrival, form.arrival) << mine.name;
    EXPECT_EQ(own.schedule.start[mine.node], kernel.schedule.start[form.node]) << mine.name;
  }
  EXPECT_EQ(own.about.record_bits, 19 * 32 + 1);
}

TEST(Record, StaysAnArgumentInOpencl) {
  EXPECT_EQ(opencl_function(scaled({"range"})), opencl_function(scaled({})));
}

// Each field that is read a cycle early gives another result, which the samples show.
TEST(Record, SamplesShowAFieldThatIsReadEarly) {
  const LoweredDesign design = scaled({"range", "gain"});
  const FunctionModel model = on_words(&scaled_in_range<FlushedFloat>);
  BenchOptions options;
  options.samples = 2000;
  const BenchSamples samples = drawn_samples("record", model, options);
  int early = 0;
  for (const MutantResult& mutant : run_graph_mutants(design, model, samples)) {
    if (!mutant.what.ends_with("read a cycle early")) continue;
    ++early;
    EXPECT_GE(mutant.sample, 0) << mutant.what;
  }
  EXPECT_EQ(early, 4);
}

}  // namespace
}  // namespace emax
