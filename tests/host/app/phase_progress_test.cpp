#include "host/app/phase_progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace emax::test {
namespace {

TEST(ExpectedShare, NeverFallsAndNeverEnds) {
  double last = 0;
  for (double elapsed = 0; elapsed < 100; elapsed += 0.125) {
    const double share = expected_share(elapsed, 10);
    EXPECT_GE(share, last) << elapsed;
    EXPECT_LT(share, 1) << elapsed;
    last = share;
  }
  EXPECT_GT(expected_share(10, 10), 0.85);
  EXPECT_EQ(expected_share(10, 0), 0);  // nobody knows
  EXPECT_EQ(expected_left(0, 10), 10);
  EXPECT_LT(expected_left(9, 10), expected_left(5, 10));
  EXPECT_GT(expected_left(30, 10), 0);
}

TEST(Minutes, HaveTwoDigitsOfSeconds) {
  EXPECT_EQ(minutes(0.4), "0:00");
  EXPECT_EQ(minutes(59.6), "1:00");
  EXPECT_EQ(minutes(3675), "61:15");
  EXPECT_EQ(rough_time(31), "35 s");
  EXPECT_EQ(rough_time(370), "6 min");
  EXPECT_EQ(rough_time(9000), "2.5 h");
}

// A short phase says nothing; a long one what it is, also while nobody calls.
TEST(PhaseProgress, SpeaksOfLongPhasesAlone) {
  testing::internal::CaptureStderr();
  {
    PhaseProgress progress;
    progress.begin("being quick", 10);
    progress.begin("being slow", 4);
    std::this_thread::sleep_for(std::chrono::milliseconds(1900));
    progress.end();
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said.find("being quick"), std::string::npos) << said;
  EXPECT_NE(said.find("being slow: 0:02, "), std::string::npos) << said;
  EXPECT_NE(said.find("%, about "), std::string::npos) << said;
}

}  // namespace
}  // namespace emax::test
