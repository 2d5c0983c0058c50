#include <gtest/gtest.h>

#include "testbench/operators/mutant_list.h"
#include "tests/testbench/link/link_bench.h"

namespace emax {
namespace {

// What went wrong, or nothing.
std::string failure_of(const Scenario& scenario, int mutant) {
  LinkBench bench(mutant, named_seed(scenario.name, 1));
  try {
    scenario.run(bench);
  } catch (const Unexpected& unexpected) {
    return scenario.name + ": " + unexpected.what();
  }
  return {};
}

class LinkRtl : public testing::TestWithParam<Scenario> {};

TEST_P(LinkRtl, Does) { EXPECT_EQ(failure_of(GetParam(), 0), ""); }

INSTANTIATE_TEST_SUITE_P(Link, LinkRtl, testing::ValuesIn(link_scenarios()),
                         [](const auto& each) { return each.param.name; });

TEST(LinkMutants, EachIsCaught) {
  int count = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.name.starts_with("LINK_")) continue;
    ++count;
    std::string caught;
    for (const Scenario& scenario : link_scenarios()) {
      caught = failure_of(scenario, mutant.number);
      if (!caught.empty()) break;
    }
    EXPECT_NE(caught, "") << mutant.name << " (" << mutant.fault << ") is not caught";
    std::printf("%-27s %s\n", mutant.name.c_str(), caught.c_str());
  }
  EXPECT_GE(count, 13);
}

}  // namespace
}  // namespace emax
