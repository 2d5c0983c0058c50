#include "testbench/cosimulation/suite.h"

#include <chrono>
#include <cstdio>

#include "sw_model/base/error.h"
#include "testbench/cosimulation/table.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

// Mismatches are printed as they are found: operands and both results.
TestReport run_operator_test(const OperatorTest& test, const CosimulationOptions& options) {
  TestReport report;
  report.name = test.name;
  report.seed = named_seed(test.name, options.seed);
  const auto start = std::chrono::steady_clock::now();
  const auto unit = test.make_unit();
  const OperatorRun run = test.run(*unit, report.seed, [&](double share) {
    if (options.progress) options.progress(share);
    report.stopped = options.stop != nullptr && *options.stop;
    return !report.stopped;
  });
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.simulating_seconds = report.seconds;
  report.pairs = run.front().pairs;
  report.cycles = unit->cycles();
  for (const OperatorResult& result : run) {
    report.mismatches += result.mismatches;
    if (result.mismatches == 0) continue;
    std::printf(
        "first mismatch of '%s', seed %llu: %s\nreplay: emax_cosim --seed %llu --filter '%s'%s\n",
        test.name.c_str(), static_cast<unsigned long long>(report.seed),
        result.first_mismatch.c_str(), static_cast<unsigned long long>(options.seed),
        test.name.c_str(), options.full ? " --full" : "");
  }
  return report;
}

}  // namespace

SuiteResult run_suite(const Suite& suite) {
  SuiteResult result;
  Table table;
  bool any = false;
  const auto run = [&](const std::string& name, const auto& run_one) {
    if (name.find(suite.filter) == std::string::npos || result.interrupted) return;
    if (!any) table.print_head();
    any = true;
    CosimulationOptions options = suite.options;
    options.progress = [&](double share) { table.show_progress(name, share); };
    TestReport report = run_one(options);
    if (suite.finish) suite.finish(report);
    table.print_row(report);
    result.pairs += report.pairs;
    result.mismatches += report.mismatches;
    result.interrupted = report.stopped;
  };
  for (const OperatorTest& test : suite.operators) {
    run(test.name, [&](const auto& options) { return run_operator_test(test, options); });
  }
  for (const ElementTest& test : element_tests()) {
    run(test.name,
        [&](const auto& options) { return run_test(test, suite.make_element, options); });
  }
  if (!any) throw Error("no test's name holds '" + suite.filter + "'; see --list");
  table.print_sum();
  return result;
}

std::vector<std::string> test_names(const Suite& suite) {
  std::vector<std::string> names;
  for (const OperatorTest& test : suite.operators) names.push_back(test.name);
  for (const ElementTest& test : element_tests()) names.push_back(test.name);
  return names;
}

}  // namespace emax
