#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "Vuarts_rtl.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::array<int, 5> kClocksPerBit = {2, 3, 4, 16, 40};

class Uarts {
 public:
  Uarts() : rtl_(&context_) {
    rtl_.rxd = 31;
    rtl_.reset = 1;
    clock(4);
    rtl_.reset = 0;
    clock(10);
  }
  ~Uarts() {
    Verilated::threadContextp(&context_);
    rtl_.final();
  }
  Vuarts_rtl& rtl() { return rtl_; }
  void clock(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      for (const int level : {0, 1}) {
        rtl_.clk = static_cast<CData>(level);
        rtl_.eval();
      }
    }
  }

 private:
  VerilatedContext context_;
  Vuarts_rtl rtl_;
};

// The line of a sender whose bits are `clocks` long, from `start` on.
int level_at(const std::vector<std::uint8_t>& bytes, double clocks, double start, double time) {
  if (time < start) return 1;
  const auto bit = static_cast<std::size_t>((time - start) / clocks);
  const std::size_t byte = bit / 10, position = bit % 10;
  if (byte >= bytes.size() || position == 9) return 1;
  return position == 0 ? 0 : bytes[byte] >> (position - 1) & 1;
}

std::vector<std::uint8_t> some_bytes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint8_t> bytes(count);
  for (std::uint8_t& byte : bytes) {
    const std::uint32_t choice = random.below(8);
    byte = choice == 0 ? 0 : choice == 1 ? 255 : static_cast<std::uint8_t>(random.word());
  }
  return bytes;
}

std::vector<std::uint8_t> receive(std::size_t i, const std::vector<std::uint8_t>& bytes,
                                  double share, double phase) {
  Uarts uarts;
  Vuarts_rtl& rtl = uarts.rtl();
  const double clocks = kClocksPerBit[i] * share,
               end = (10.0 * static_cast<double>(bytes.size()) + 20) * clocks;
  std::vector<std::uint8_t> received;
  for (int cycle = 0; cycle < end; ++cycle) {
    const int level = level_at(bytes, clocks, 5 + phase, cycle);
    rtl.rxd = static_cast<CData>((31u & ~(1u << i)) | static_cast<unsigned>(level) << i);
    uarts.clock();
    if (rtl.received_valid >> i & 1)
      received.push_back(static_cast<std::uint8_t>(rtl.received >> (8 * i)));
    EXPECT_EQ(rtl.received_valid & ~(1 << i), 0) << "a byte on a line that was quiet";
  }
  return received;
}

TEST(Uart, ReceivesBackToBackBytes) {
  const auto bytes = some_bytes(300, named_seed("ReceivesBackToBackBytes", 1));
  for (std::size_t i = 0; i < kClocksPerBit.size(); ++i)
    EXPECT_EQ(receive(i, bytes, 1, 0), bytes) << kClocksPerBit[i];
}

TEST(Uart, ReceivesWithAnotherClock) {
  const auto bytes = some_bytes(300, named_seed("ReceivesWithAnotherClock", 1));
  for (const std::size_t i : {3, 4})
    for (const double share : {0.98, 0.99, 1.01, 1.02})
      for (const double phase : {0.0, 0.3, 0.6, 0.9})
        EXPECT_EQ(receive(i, bytes, share, phase), bytes) << kClocksPerBit[i] << ' ' << share;
}

TEST(Uart, AClockTooFarOffIsSeen) {
  const auto bytes = some_bytes(300, named_seed("AClockTooFarOffIsSeen", 1));
  for (const double share : {0.92, 1.08}) EXPECT_NE(receive(4, bytes, share, 0), bytes) << share;
}

// Held low as by a board without power: one byte, and sound ones once the line has been high.
TEST(Uart, AHeldLineGivesOneByte) {
  for (std::size_t i = 0; i < kClocksPerBit.size(); ++i) {
    Uarts uarts;
    Vuarts_rtl& rtl = uarts.rtl();
    int bytes = 0;
    unsigned last = 0;
    const auto run = [&](int level, int bits) {
      rtl.rxd = static_cast<CData>(level ? 31u : 31u & ~(1u << i));
      for (int cycle = 0; cycle < bits * kClocksPerBit[i]; ++cycle) {
        uarts.clock();
        bytes += rtl.received_valid >> i & 1;
        if (rtl.received_valid >> i & 1) last = rtl.received >> (8 * i) & 255;
      }
    };
    run(0, 100);
    EXPECT_EQ(bytes, 1);
    EXPECT_EQ(last, 0u);
    run(1, 3);
    for (const int bit : {0, 1, 0, 1, 0, 0, 1, 0, 1}) run(bit, 1);  // start and 0xa5
    run(1, 3);
    EXPECT_EQ(bytes, 2);
    EXPECT_EQ(last, 0xa5u);
  }
}

TEST(Uart, AGlitchIsNoStartBit) {
  for (const std::size_t i : {3, 4}) {
    Uarts uarts;
    Vuarts_rtl& rtl = uarts.rtl();
    rtl.rxd = static_cast<CData>(31u & ~(1u << i));
    uarts.clock(kClocksPerBit[i] / 2 - 2);
    rtl.rxd = 31;
    for (int cycle = 0; cycle < 20 * kClocksPerBit[i]; ++cycle) {
      uarts.clock();
      EXPECT_EQ(rtl.received_valid, 0);
    }
  }
}

TEST(Uart, SendsWhatAReceiverReads) {
  const auto bytes = some_bytes(200, named_seed("SendsWhatAReceiverReads", 1));
  for (std::size_t i = 0; i < kClocksPerBit.size(); ++i) {
    Uarts uarts;
    Vuarts_rtl& rtl = uarts.rtl();
    std::size_t sent = 0;
    std::vector<int> line;
    for (int cycle = 0; cycle < 2300 * kClocksPerBit[i]; ++cycle) {
      rtl.to_send_valid = static_cast<CData>(sent < bytes.size() ? 1u << i : 0u);
      if (sent < bytes.size()) rtl.to_send = bytes[sent];
      rtl.clk = 0;
      rtl.eval();
      sent += rtl.to_send_valid & rtl.to_send_ready ? 1 : 0;
      line.push_back(rtl.txd >> i & 1);
      rtl.clk = 1;
      rtl.eval();
    }
    // Each bit is on the line for its whole time: looked at in its first and its last clock.
    std::vector<std::uint8_t> received;
    const auto clocks = static_cast<std::size_t>(kClocksPerBit[i]);
    for (std::size_t at = 0; at + 10 * clocks < line.size(); ++at) {
      if (line[at]) continue;
      unsigned byte = 0;
      for (std::size_t bit = 0; bit < 10; ++bit) {
        EXPECT_EQ(line[at + bit * clocks], line[at + bit * clocks + clocks - 1]);
        byte |= static_cast<unsigned>(line[at + bit * clocks]) << bit;
      }
      EXPECT_EQ(byte >> 9, 1u) << "no stop bit";
      received.push_back(static_cast<std::uint8_t>(byte >> 1));
      at += 10 * clocks - 1;
    }
    EXPECT_EQ(received, bytes) << kClocksPerBit[i];
  }
}

}  // namespace
}  // namespace emax
