#include "tests/testbench/link/link_bench.h"

#include "Vlink_rtl___024root.h"
#include "Vlink_rtl_emax_mutation.h"
#include "hls/kernel/command_words.h"

namespace emax {
namespace {

constexpr int kByteClocks = 8;  // as close as bytes may come
constexpr int kQuietClocks = 200;

}  // namespace

void expect(bool condition, const std::string& what) {
  if (!condition) throw Unexpected(what);
}

LinkBench::LinkBench(int mutant, std::uint64_t seed) : random(seed), rtl_(&context_) {
  context_.fatalOnError(false);
  rtl_.clk = 0;
  rtl_.aresetn = 0;
  rtl_.eval();  // its initial blocks make the design unchanged
  rtl_.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant);
  clock(4);
  rtl_.aresetn = 1;
  clock(40);
  resets_of_core = longest_reset = 0;
}

LinkBench::~LinkBench() {
  Verilated::threadContextp(&context_);
  rtl_.final();
}

void LinkBench::send(std::span<const std::uint8_t> bytes) {
  to_device_.insert(to_device_.end(), bytes.begin(), bytes.end());
}

std::vector<Frame> LinkBench::take_frames() {
  std::vector<Frame> frames;
  while (auto frame = reader_.next()) frames.push_back(*std::move(frame));
  return frames;
}

std::vector<Frame> LinkBench::settle() {
  for (quiet_ = 0; quiet_ < kQuietClocks;) clock();
  return take_frames();
}

Frame LinkBench::ask(const Frame& frame) {
  send(frame);
  const std::vector<Frame> frames = settle();
  expect(frames.size() == 1, std::to_string(frames.size()) + " frames answer one");
  return frames[0];
}

void LinkBench::drive() {
  const bool may_send = since_byte_ >= kByteClocks && !to_device_.empty();
  rtl_.s_byte_valid = may_send;
  if (may_send) {
    rtl_.s_byte_data = to_device_.front();
    to_device_.pop_front();
    since_byte_ = 0;
    quiet_ = 0;
  }
  ++since_byte_;
  const auto acts = [&] { return idle == 0 || random.one_in(idle + 1); };
  rtl_.m_byte_ready = acts();
  rtl_.m_axis_command_tready = takes && rtl_.core_aresetn && acts();
  // An offered answer stays until it is taken.
  if (!rtl_.s_axis_answer_tvalid) rtl_.s_axis_answer_tvalid = !answers.empty() && acts();
  if (!rtl_.core_aresetn) rtl_.s_axis_answer_tvalid = 0;
  if (rtl_.s_axis_answer_tvalid) rtl_.s_axis_answer_tdata = answers.front();
}

void LinkBench::clock(int cycles) {
  for (int i = 0; i < cycles; ++i) {
    drive();
    rtl_.eval();
    const bool command = rtl_.m_axis_command_tvalid && rtl_.m_axis_command_tready;
    const bool answer = rtl_.s_axis_answer_tvalid && rtl_.s_axis_answer_tready;
    ++quiet_;
    if (rtl_.m_byte_valid) quiet_ = 0;
    if (rtl_.m_byte_valid && rtl_.m_byte_ready) {
      const std::uint8_t byte = rtl_.m_byte_data;
      reader_.add({&byte, 1});
    }
    if (command) {
      taken.push_back(rtl_.m_axis_command_tdata);
      if (echoes) answers.push_back(~rtl_.m_axis_command_tdata);
    }
    if (command || answer) quiet_ = 0;
    if (!rtl_.core_aresetn) {
      words_in_reset += (rtl_.m_axis_command_tvalid || rtl_.s_axis_answer_tready) && in_reset_ > 1;
      if (in_reset_++ == 0) ++resets_of_core;
      longest_reset = std::max(longest_reset, in_reset_);
      taken.clear();
      answers.clear();
    } else {
      in_reset_ = 0;
    }
    rtl_.clk = 1;
    rtl_.eval();
    if (answer) {
      if (!answers.empty()) answers.pop_front();
      rtl_.s_axis_answer_tvalid = 0;
    }
    rtl_.clk = 0;
    rtl_.eval();
  }
  expect(!context_.gotError(), "an assertion of the design failed");
}

Frame data_frame(std::uint8_t sequence, std::vector<Word> payload, std::uint8_t expected) {
  return {.kind = FrameKind::kData,
          .session = kSession,
          .sequence = sequence,
          .expected = expected,
          .credit = 65535,
          .payload = std::move(payload)};
}

Frame plain_frame(FrameKind kind, std::uint8_t expected, std::uint16_t session) {
  return {.kind = kind, .session = session, .expected = expected, .credit = 65535};
}

std::vector<Word> numbered_words(std::size_t count, Word first) {
  std::vector<Word> words(count);
  for (std::size_t i = 0; i < count; ++i) words[i] = first + static_cast<Word>(i);
  return words;
}

std::vector<Word> answer_of(std::size_t count) {
  std::vector<Word> words = numbered_words(count);
  words[0] = command_header(kReduce, static_cast<Word>(count - 1));
  return words;
}

}  // namespace emax
