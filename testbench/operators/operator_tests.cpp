#include "testbench/operators/operator_tests.h"

namespace emax {

std::vector<OperatorTest> operator_tests(bool full) {
  const auto every_pair = [](SmallFormat format) {
    return [format](OperatorUnit& unit, std::uint64_t, const OperatorWatch&) {
      return run_small_cosim(unit, format);
    };
  };
  return {binary32_test(make_operators_8_23, full ? 100'000'000 : 4'000'000),
          {"operators: every pair of 1+4+3 bits", make_operators_4_3, every_pair({4, 3})},
          {"operators: every pair of 1+5+2 bits", make_operators_5_2, every_pair({5, 2})}};
}

}  // namespace emax
