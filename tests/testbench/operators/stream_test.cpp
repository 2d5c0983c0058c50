// pipeline_stream: what is accepted comes out once, in order, with its tlast, through idle cycles
// and back-pressure, and at full rate without them; a reset in flight leaves nothing behind.
#include <Vstream_0_rtl.h>
#include <Vstream_100_rtl.h>
#include <Vstream_10_rtl.h>
#include <Vstream_10_rtl___024root.h>
#include <Vstream_10_rtl_emax_mutation.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <deque>
#include <utility>

#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/random.h"
#include "tests/testbench/operators/clock_edge.h"

namespace emax {
namespace {

// Of 16 cycles, those in which a sample is offered and those in which a result is taken.
struct StreamPace {
  std::uint32_t offered, taken;
};

struct StreamRun {
  int accepted = 0, received = 0, wrong = 0;
  bool sound() const { return wrong == 0 && accepted == received && received > 0; }
};

template <class Rtl>
void reset_stream(Rtl& rtl) {
  rtl.s_axis_tvalid = 0;
  rtl.m_axis_tready = 0;
  rtl.clk = 0;
  rtl.aresetn = 0;
  for (int i = 0; i < 4; ++i) clock_edge(rtl);
  rtl.aresetn = 1;
}

// Offers samples for `cycles`, then lets everything drain.
template <class Rtl>
StreamRun run_stream(Rtl& rtl, StreamPace pace, int cycles, Random& random) {
  constexpr int kDrain = 400;
  StreamRun run;
  std::deque<std::pair<int, bool>> in_flight;
  bool waits = false;  // an offered sample stays until it is accepted
  for (int cycle = 0; cycle < cycles + kDrain; ++cycle) {
    if (!waits) {
      rtl.s_axis_tvalid = cycle < cycles && random.below(16) < pace.offered;
      rtl.s_axis_tdata = static_cast<CData>(random.bits());
      rtl.s_axis_tlast = random.one_in(4);
    }
    rtl.m_axis_tready = cycle >= cycles || random.below(16) < pace.taken;
    rtl.eval();
    waits = rtl.s_axis_tvalid && !rtl.s_axis_tready;
    if (rtl.s_axis_tvalid && rtl.s_axis_tready) {
      ++run.accepted;
      in_flight.emplace_back(rtl.s_axis_tdata, rtl.s_axis_tlast != 0);
    }
    if (rtl.m_axis_tvalid && rtl.m_axis_tready) {
      ++run.received;
      const std::pair<int, bool> result{rtl.m_axis_tdata, rtl.m_axis_tlast != 0};
      if (in_flight.empty() || in_flight.front() != result) ++run.wrong;
      if (!in_flight.empty()) in_flight.pop_front();
    }
    clock_edge(rtl);
  }
  return run;
}

constexpr StreamPace kPaces[] = {{16, 16}, {16, 3}, {3, 16}, {8, 8}, {16, 0}};

template <class Rtl>
void expect_sound() {
  VerilatedContext context;
  Rtl rtl(&context);
  Random random(named_seed("streams", 1));
  for (const StreamPace& pace : kPaces) {
    reset_stream(rtl);
    const StreamRun run = run_stream(rtl, pace, 3000, random);
    EXPECT_TRUE(run.sound()) << pace.offered << ' ' << pace.taken << ": " << run.accepted
                             << " accepted, " << run.received << " received, " << run.wrong
                             << " wrong";
    if (pace.offered == 16 && pace.taken == 16) {
      EXPECT_GT(run.accepted, 2990);
    }
  }
}

TEST(PipelineStream, GivesEveryAcceptedSampleOnceInOrder) {
  expect_sound<Vstream_10_rtl>();
  expect_sound<Vstream_0_rtl>();
  expect_sound<Vstream_100_rtl>();
}

TEST(PipelineStream, ResetInFlightLeavesNothingBehind) {
  VerilatedContext context;
  Vstream_10_rtl rtl(&context);
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    reset_stream(rtl);
    rtl.m_axis_tready = 0;
    for (std::uint32_t cycle = random.below(40); cycle > 0; --cycle) {
      rtl.s_axis_tvalid = 1;
      rtl.s_axis_tdata = 0xff;
      clock_edge(rtl);
    }
    reset_stream(rtl);
    EXPECT_TRUE(run_stream(rtl, {8, 8}, 200, random).sound());
  }
}

TEST(PipelineStream, EveryMutantIsCaught) {
  int tried = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (mutant.module != "stream/pipeline_stream") continue;
    ++tried;
    VerilatedContext context;
    context.assertOn(false);  // the FIFO's own check would end the run
    Vstream_10_rtl rtl(&context);
    rtl.eval();  // its initial blocks make the design unchanged
    Random random(3);
    reset_stream(rtl);
    EXPECT_TRUE(run_stream(rtl, {16, 3}, 1000, random).sound());
    rtl.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant.number);
    reset_stream(rtl);
    EXPECT_FALSE(run_stream(rtl, {16, 3}, 1000, random).sound()) << mutant.name;
    Verilated::threadContextp(&context);  // as in verilated_operators.h
  }
  EXPECT_EQ(tried, 2);
}

}  // namespace
}  // namespace emax
