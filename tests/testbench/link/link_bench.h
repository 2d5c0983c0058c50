// The Verilated emax_link between bytes and a core that is written here.
#pragma once

#include <cstdint>
#include <deque>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "Vlink_rtl.h"
#include "sw_model/base/error.h"
#include "sw_model/protocol/frames.h"
#include "testbench/stimuli/random.h"

namespace emax {

// What a scenario expected and did not see.
struct Unexpected : Error {
  using Error::Error;
};

// Throws Unexpected.
void expect(bool condition, const std::string& what);

constexpr Word kRoom = 1024;                // of the bench's build of emax_link
constexpr int kGapClocks = 3000;            // likewise
constexpr std::uint16_t kSession = 0x4de5;  // holds the sync bytes

class LinkBench {
 public:
  LinkBench(int mutant, std::uint64_t seed);
  ~LinkBench();
  LinkBench(const LinkBench&) = delete;
  LinkBench& operator=(const LinkBench&) = delete;

  // Queues bytes for the device.
  void send(std::span<const std::uint8_t> bytes);
  void send(const Frame& frame) { send(encode(frame)); }
  // Clocks until every byte is in and nothing has come out for a while; the frames that came.
  std::vector<Frame> settle();
  // The one frame that comes after `frame` is sent; throws Unexpected for none or several.
  Frame ask(const Frame& frame);
  void clock(int cycles = 1);
  std::vector<Frame> take_frames();
  bool sending() const { return !to_device_.empty(); }

  // The core: words that it took, since its reset; words that it is yet to answer, each answer with
  // its header.
  std::vector<Word> taken;
  std::deque<Word> answers;
  bool takes = true;
  bool echoes = false;     // answers ~word
  std::uint32_t idle = 0;  // in a cycle of `idle + 1`, at random, a side may act; 0: always
  int resets_of_core = 0;
  int longest_reset = 0;
  int words_in_reset = 0;
  std::uint64_t dropped() const { return reader_.dropped(); }

  Random random;

 private:
  void drive();

  VerilatedContext context_;
  Vlink_rtl rtl_;
  std::deque<std::uint8_t> to_device_;
  FrameReader reader_;
  int since_byte_ = 0;
  int quiet_ = 0;
  int in_reset_ = 0;
};

// A data frame of the session; the tests' words are told apart by their position.
Frame data_frame(std::uint8_t sequence, std::vector<Word> payload, std::uint8_t expected = 0);
Frame plain_frame(FrameKind kind, std::uint8_t expected = 0, std::uint16_t session = kSession);
std::vector<Word> numbered_words(std::size_t count, Word first = 0x4de50000u);
// An answer of this many words: its header counts those after it, which are numbered.
std::vector<Word> answer_of(std::size_t count);

struct Scenario {
  std::string name;
  void (*run)(LinkBench&);

  friend std::ostream& operator<<(std::ostream& out, const Scenario& scenario) {
    return out << scenario.name;
  }
};
const std::vector<Scenario>& link_scenarios();

// Words, `count` or a few more, through a link that damages, drops, doubles and holds frames back,
// both ways, and back again as answers; of 1000 frames, `faults` suffer. Throws Unexpected.
void pass_words_through_faults(LinkBench& bench, std::size_t count, std::uint32_t faults);

}  // namespace emax
