#include "host/app/device_report.h"

#include <gtest/gtest.h>

#include "host/block_search/simd_evaluator.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(DescribeCounters, LeavesOutWhatIsNotMeasured) {
  DeviceCounters counters;
  counters.blocks = 12;
  counters.pairs = 3456789;
  EXPECT_EQ(describe_counters(counters), "12 blocks, 3,456,789 pairs");
  counters.words_in = 1000;
  counters.words_out = 36;
  EXPECT_EQ(describe_counters(counters), "12 blocks, 3,456,789 pairs, 1,000 words in, 36 out");
  counters.resends = 0;
  EXPECT_EQ(describe_counters(counters),
            "12 blocks, 3,456,789 pairs, 1,000 words in, 36 out, 0 resends");
  counters.cycles = 8000;
  EXPECT_EQ(describe_counters(counters),
            "12 blocks, 3,456,789 pairs, 1,000 words in, 36 out, 8,000 cycles, 0 resends");
  counters.busy = 7000;
  counters.idle = 900;
  EXPECT_EQ(describe_counters(counters),
            "12 blocks, 3,456,789 pairs, 1,000 words in, 36 out, 8,000 cycles (87.5% busy, 11.2% "
            "idle), 0 resends");
  counters.stalled = 100;
  EXPECT_EQ(describe_counters(counters),
            "12 blocks, 3,456,789 pairs, 1,000 words in, 36 out, 8,000 cycles (87.5% busy, 1.2% "
            "stalled, 11.2% idle), 0 resends");
  EXPECT_EQ(describe_counters(std::nullopt),
            std::string(engine_targets().front().name) + " instructions");
}

TEST(CpuTwin, FindsTheSameErrorOrSaysSo) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 2500, 81);
  ErrorConstraint constraint(s.cloud, 1, 0);
  SimdEvaluator device;
  MeasuredError measured = constraint.measure(s.mesh(), device);
  CpuTwin cpu(constraint);
  EXPECT_EQ(cpu.seconds(), 0);
  cpu.measure(s.mesh(), measured);
  const double once = cpu.seconds();
  EXPECT_GT(once, 0);
  cpu.measure(s.mesh(), measured);
  EXPECT_GT(cpu.seconds(), once);
  measured.kept.squared_bits ^= 1;
  EXPECT_THROW(cpu.measure(s.mesh(), measured), Error);
}

}  // namespace
}  // namespace emax
