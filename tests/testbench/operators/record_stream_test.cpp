// record_stream: the samples of packet i meet record i, and their results come out once, in order,
// with their tlast, through idle cycles and back-pressure of all three streams, after resets, and
// at full rate.
#include <Vrecord_stream_0_rtl.h>
#include <Vrecord_stream_9_rtl.h>
#include <Vrecord_stream_rtl.h>
#include <Vrecord_stream_rtl___024root.h>
#include <Vrecord_stream_rtl_emax_mutation.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <deque>
#include <utility>

#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/random.h"
#include "tests/testbench/operators/clock_edge.h"

namespace emax {
namespace {

// Of 16 cycles, those in which a record and a sample are offered and a result is taken; one of
// `length` samples is its record's last.
struct RecordPace {
  std::uint32_t records, samples, taken, length;
};

struct RecordRun {
  int records = 0, accepted = 0, received = 0, wrong = 0;
  bool sound() const { return wrong == 0 && accepted == received && received > 0; }
};

template <class Rtl>
void reset_record_stream(Rtl& rtl) {
  rtl.s_axis_record_tvalid = 0;
  rtl.s_axis_tvalid = 0;
  rtl.m_axis_tready = 0;
  rtl.clk = 0;
  rtl.aresetn = 0;
  for (int i = 0; i < 4; ++i) clock_edge(rtl);
  rtl.aresetn = 1;
}

// Offers records and samples for `cycles`, then lets what was accepted drain.
template <class Rtl>
class RecordStreamRun {
 public:
  RecordStreamRun(Rtl& rtl, const RecordPace& pace, Random& random)
      : rtl_(rtl), pace_(pace), random_(random) {}

  RecordRun run(int cycles) {
    constexpr int kDrain = 400;
    for (int cycle = 0; cycle < cycles + kDrain; ++cycle) {
      offer(cycle < cycles);
      rtl_.m_axis_tready = cycle >= cycles || random_.below(16) < pace_.taken;
      rtl_.eval();
      take_result();
      accept();
      clock_edge(rtl_);
    }
    return run_;
  }

 private:
  void offer(bool offers) {
    if (!record_waits_) {
      rtl_.s_axis_record_tvalid = offers && random_.below(16) < pace_.records;
      rtl_.s_axis_record_tdata = static_cast<CData>(random_.bits());
    }
    if (!sample_waits_) {
      rtl_.s_axis_tvalid = offers && random_.below(16) < pace_.samples;
      rtl_.s_axis_tdata = static_cast<CData>(random_.bits());
      rtl_.s_axis_tlast = random_.one_in(pace_.length);
    }
  }

  void accept() {
    record_waits_ = rtl_.s_axis_record_tvalid && !rtl_.s_axis_record_tready;
    sample_waits_ = rtl_.s_axis_tvalid && !rtl_.s_axis_tready;
    if (rtl_.s_axis_tvalid && !sample_waits_) {
      ++run_.accepted;
      if (records_.empty()) {
        ++run_.wrong;  // it meets no record
        return;
      }
      in_flight_.emplace_back(records_.front() << 8 | rtl_.s_axis_tdata, rtl_.s_axis_tlast != 0);
      if (rtl_.s_axis_tlast) records_.pop_front();
    }
    if (rtl_.s_axis_record_tvalid && !record_waits_) {
      ++run_.records;
      records_.push_back(rtl_.s_axis_record_tdata);
    }
  }

  void take_result() {
    if (!rtl_.m_axis_tvalid || !rtl_.m_axis_tready) return;
    ++run_.received;
    const std::pair<int, bool> result{rtl_.m_axis_tdata, rtl_.m_axis_tlast != 0};
    if (in_flight_.empty() || in_flight_.front() != result) ++run_.wrong;
    if (!in_flight_.empty()) in_flight_.pop_front();
  }

  Rtl& rtl_;
  const RecordPace pace_;
  Random& random_;
  RecordRun run_;
  std::deque<int> records_;
  std::deque<std::pair<int, bool>> in_flight_;
  bool record_waits_ = false, sample_waits_ = false;  // what is offered stays until it is accepted
};

constexpr RecordPace kRecordPaces[] = {{16, 16, 16, 1}, {16, 16, 16, 20}, {16, 16, 3, 4},
                                       {2, 16, 16, 1},  {2, 16, 16, 30},  {16, 3, 16, 2},
                                       {8, 8, 8, 2},    {16, 16, 0, 3},   {1, 16, 8, 5}};

template <class Rtl>
void expect_sound_records(bool every_cycle) {
  VerilatedContext context;
  Rtl rtl(&context);
  Random random(named_seed("record streams", 1));
  for (const RecordPace& pace : kRecordPaces) {
    reset_record_stream(rtl);
    const RecordRun run = RecordStreamRun(rtl, pace, random).run(3000);
    EXPECT_TRUE(run.sound()) << pace.records << ' ' << pace.samples << ' ' << pace.taken << ' '
                             << pace.length << ": " << run.records << " records, " << run.accepted
                             << " accepted, " << run.received << " received, " << run.wrong
                             << " wrong";
    const bool full = pace.records == 16 && pace.samples == 16 && pace.taken == 16;
    if (full && (every_cycle || pace.length == 20)) {
      EXPECT_GT(run.accepted, 2980);
    }
  }
}

TEST(RecordStream, PacketsMeetTheirRecords) {
  expect_sound_records<Vrecord_stream_rtl>(false);
  expect_sound_records<Vrecord_stream_0_rtl>(true);
  expect_sound_records<Vrecord_stream_9_rtl>(true);
}

TEST(RecordStream, ResetInFlightLeavesNothingBehind) {
  VerilatedContext context;
  Vrecord_stream_rtl rtl(&context);
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    reset_record_stream(rtl);
    for (std::uint32_t cycle = random.below(40); cycle > 0; --cycle) {
      rtl.s_axis_record_tvalid = rtl.s_axis_tvalid = 1;
      rtl.s_axis_tlast = random.one_in(2);
      rtl.s_axis_record_tdata = rtl.s_axis_tdata = 0xff;
      clock_edge(rtl);
    }
    reset_record_stream(rtl);
    EXPECT_TRUE(RecordStreamRun(rtl, {8, 8, 8, 2}, random).run(200).sound());
  }
}

// The ring's mutants too, which the element's testbench has otherwise.
TEST(RecordStream, EveryMutantIsCaught) {
  int tried = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (mutant.module != "stream/record_stream" && mutant.module != "record_ring") continue;
    ++tried;
    VerilatedContext context;
    context.assertOn(false);  // the ring's own check would end the run
    Vrecord_stream_rtl rtl(&context);
    rtl.eval();  // its initial blocks make the design unchanged
    Random random(3);
    reset_record_stream(rtl);
    EXPECT_TRUE(RecordStreamRun(rtl, {8, 16, 8, 2}, random).run(1000).sound());
    rtl.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant.number);
    reset_record_stream(rtl);
    EXPECT_FALSE(RecordStreamRun(rtl, {8, 16, 16, 2}, random).run(1000).sound() &&
                 RecordStreamRun(rtl, {16, 16, 8, 1}, random).run(1000).sound())
        << mutant.name;
    Verilated::threadContextp(&context);  // as in verilated_operators.h
  }
  EXPECT_EQ(tried, 6);
}

}  // namespace
}  // namespace emax
