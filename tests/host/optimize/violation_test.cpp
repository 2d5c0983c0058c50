#include <gtest/gtest.h>

#include "host/optimize/optimize.h"

namespace emax::test {
namespace {

// Each of the three bounds is broken where the others hold.
TEST(Violation, IsThatOfTheWorstBound) {
  const DecimationBound bound = {2, 4, {}, {}};
  MeasuredError error = {};
  error.violation = -0.5;
  ChainResult made;
  made.back_distance = made.reference_distance = 1;
  EXPECT_EQ(violation_of(made, error, bound), -0.5);
  made.reference_distance = 3;
  EXPECT_EQ(violation_of(made, error, bound), 0.5);
  made.reference_distance = 1;
  made.back_distance = 8;
  EXPECT_EQ(violation_of(made, error, bound), 1);
  EXPECT_EQ(violation_of(made, error, {2, 0, {}, {}}), -0.5);  // one-sided
  error.violation = 1.5;
  EXPECT_EQ(violation_of(made, error, bound), 1.5);
  made.topology_difference = 3;
  error.violation = -0.5;
  made.back_distance = 1;
  EXPECT_EQ(violation_of(made, error, bound), 0.75);
}

}  // namespace
}  // namespace emax::test
