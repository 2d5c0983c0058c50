// The list of co-simulation tests of the operators. Each drives all operators with the same pairs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "testbench/operators/operator_cosim.h"
#include "testbench/operators/operator_unit.h"

namespace emax {

struct OperatorTest {
  std::string name;
  std::function<std::unique_ptr<OperatorUnit>()> make_unit;
  std::function<OperatorRun(OperatorUnit&, std::uint64_t seed, const OperatorWatch&)> run;
};

// `pairs` random pairs after all corner pairs.
OperatorTest binary32_test(std::function<std::unique_ptr<OperatorUnit>()> make_unit,
                           std::uint64_t pairs);

// binary32_test on the fastest build with 4 million pairs, or 10^8 with `full`, and every pair of
// two formats of 8 bits. In the library emax_operators.
std::vector<OperatorTest> operator_tests(bool full);

}  // namespace emax
