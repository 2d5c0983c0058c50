// All tests of the co-simulation, operators first, and their table.
#pragma once

#include <string>
#include <vector>

#include "testbench/cosimulation/cosimulation.h"
#include "testbench/operators/operator_tests.h"

namespace emax {

struct Suite {
  std::vector<OperatorTest> operators;
  ElementFactory make_element;
  CosimulationOptions options;
  std::string filter;  // only tests whose name contains it
  // Called after each test, before its row is printed.
  std::function<void(TestReport&)> finish;
};

struct SuiteResult {
  std::uint64_t pairs = 0, mismatches = 0;
  bool interrupted = false;
};

// Throws Error where no test's name contains the filter.
SuiteResult run_suite(const Suite& suite);

// The tests that run_suite runs with an empty filter.
std::vector<std::string> test_names(const Suite& suite);

}  // namespace emax
