#include <gtest/gtest.h>

#include "host/optimize/optimize.h"

namespace emax::test {
namespace {

using Values = std::vector<double>;

TEST(Constraints, AreOneForEachBound) {
  MeasuredError error = {};
  error.violation = -0.5;
  ChainResult made;
  made.back_distance = 8;
  made.reference_distance = 3;
  EXPECT_EQ(constraints_of(made, error, {2, 4, {}, {}}), (Values{-0.5, 1, 0.5, -1}));
  EXPECT_EQ(constraints_of(made, error, {2, 0, {}, {}}), Values{-0.5});  // one-sided
  made.topology_difference = 3;
  EXPECT_EQ(constraints_of(made, error, {2, 4, {}, {}}), (Values{-0.5, 1, 0.5, 0.75}));
}

}  // namespace
}  // namespace emax::test
