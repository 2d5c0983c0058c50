#include "testbench/board/simulated_board.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cpp_device.h"
#include "sw_model/protocol/cycle_model.h"
#include "sw_model/protocol/frames.h"
#include "testbench/stimuli/stimuli.h"

namespace emax {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kSession = 300;
constexpr Word kIdentify = 0x01000000;
constexpr Word kAnswerOfFive = 0x01000005;
constexpr Word kClockKhz = 1000 * kUlx3sClockMhz;  // which the board takes from its top

void send(SimulatedBoard& board, const Frame& frame) {
  const std::vector<std::uint8_t> bytes = encode(frame);
  EXPECT_EQ(board.write(bytes), bytes.size());
}

std::optional<Frame> receive(SimulatedBoard& board) {
  FrameReader reader;
  std::array<std::uint8_t, 64> bytes;
  while (const std::size_t count = board.read(bytes, 100ms)) {
    reader.add(std::span(bytes).first(count));
    if (auto frame = reader.next()) return frame;
  }
  return std::nullopt;
}

std::optional<Frame> ask(SimulatedBoard& board, const Frame& frame) {
  send(board, frame);
  return receive(board);
}

// A session, and what the board says of itself.
std::vector<Word> identify(SimulatedBoard& board) {
  const auto status = ask(board, {.kind = FrameKind::kReset, .session = kSession});
  EXPECT_TRUE(status && status->kind == FrameKind::kStatus && status->session == kSession);
  EXPECT_TRUE(ask(board, {.kind = FrameKind::kData, .session = kSession, .payload = {kIdentify}}));
  const auto data = receive(board);
  return data && data->kind == FrameKind::kData ? data->payload : std::vector<Word>{};
}

const std::vector<Word> kIdentity = {kAnswerOfFive, 1, 1024, 20, 1, kClockKhz};

TEST(SimulatedBoard, SaysWhatItIs) {
  SimulatedBoard board;
  EXPECT_EQ(identify(board), kIdentity);
}

// All words to the board, a frame at a time, and `answers` words from it.
std::vector<Word> exchange(SimulatedBoard& board, std::span<const Word> words,
                           std::size_t answers) {
  std::vector<Word> received;
  std::uint8_t sequence = 0, expected = 0;
  Frame poll = {.kind = FrameKind::kPoll, .session = kSession};
  EXPECT_TRUE(ask(board, {.kind = FrameKind::kReset, .session = kSession}));
  while (received.size() < answers || !words.empty()) {
    poll.expected = expected;
    Frame frame = poll;
    if (!words.empty()) {
      const auto part = words.first(std::min(words.size(), kMaxFrameWords));
      frame.kind = FrameKind::kData;
      frame.sequence = sequence;
      frame.payload.assign(part.begin(), part.end());
    }
    const auto answer = ask(board, frame);
    if (!answer) {
      ADD_FAILURE() << "no answer";
      break;
    }
    if (!words.empty() && answer->expected == static_cast<std::uint8_t>(sequence + 1)) {
      words = words.subspan(frame.payload.size());
      ++sequence;
    }
    if (answer->kind != FrameKind::kData || answer->sequence != expected) continue;
    received.insert(received.end(), answer->payload.begin(), answer->payload.end());
    ++expected;
  }
  return received;
}

TEST(SimulatedBoard, GivesTheModelsAnswers) {
  const test::Stimulus sphere = test::bumpy_sphere(8, 8, 300, 1);
  const Normalization normalization = normalization_of(sphere.cloud);
  const auto points = normalized_points(sphere.cloud, normalization);
  std::vector<Word> words = {kIdentify};
  append_load_points(words, points);
  append_records(words, make_records(sphere.mesh(), normalization));
  append_reduce(words, true);
  CppDevice model;
  model.send(words);
  std::vector<Word> expected(6 + 3 + points.size());
  model.receive(expected);
  // What differs by right: elements and clock.
  expected[4] = kIdentity[4];
  expected[5] = kIdentity[5];
  SimulatedBoard board;
  EXPECT_EQ(exchange(board, words, expected.size()), expected);
}

TEST(SimulatedBoard, SaysWhatItsFilterAndItsStoreAre) {
  const std::vector<Word> words = {command_header(emax::kIdentify, kOfFilter),
                                   command_header(emax::kIdentify, kOfStore)};
  SimulatedBoard board;
  EXPECT_EQ(
      exchange(board, words, 9),
      (std::vector<Word>{kAnswerOfFive, kFilterVersion, 1024, kFilterRecordWords, 4, kClockKhz,
                         command_header(emax::kIdentify, kAnswerStore), kStoreVersion, 1u << 14}));
}

TEST(SimulatedBoard, GivesEqualBytesAtEqualTimes) {
  SimulatedBoard first, second;
  EXPECT_EQ(identify(first), identify(second));
  EXPECT_EQ(first.now(), second.now());
  EXPECT_EQ(first.cycles(), second.cycles());
}

TEST(SimulatedBoard, IsNotClockedWhereNothingCanCome) {
  SimulatedBoard board;
  EXPECT_FALSE(board.settled());
  std::array<std::uint8_t, 1> byte;
  EXPECT_EQ(board.read(byte, 10s), 0u);
  EXPECT_TRUE(board.settled());
  EXPECT_GE(board.now(), 10s);
  EXPECT_LT(board.now(), 10s + 1ms);
  EXPECT_LT(board.cycles(), 1'000'000u);
  EXPECT_EQ(identify(board), kIdentity);
}

TEST(SimulatedBoard, TimePassesAsAsked) {
  SimulatedBoard board;
  const auto before = board.now();
  std::array<std::uint8_t, 1> byte;
  EXPECT_EQ(board.read(byte, 200us), 0u);
  EXPECT_EQ(board.now() - before, 200us);
}

TEST(SimulatedBoard, TakesNoMoreThanWaitsForTheLine) {
  SimulatedBoard board;
  const std::vector<std::uint8_t> bytes(10'000, 0x55);
  EXPECT_EQ(board.write(bytes), 4096u);
  EXPECT_EQ(board.write(bytes), 0u);
  std::array<std::uint8_t, 1> byte;
  EXPECT_EQ(board.read(byte, 100us), 0u);
  EXPECT_EQ(board.write(bytes), 100u * kUlx3sClockMhz / 20);  // a byte is 20 clocks
}

TEST(SimulatedBoard, ForgetsItsSessionAtTheResetButton) {
  SimulatedBoard board;
  identify(board);
  const Frame poll = {.kind = FrameKind::kPoll, .session = kSession};
  EXPECT_EQ(ask(board, poll)->kind, FrameKind::kData);
  board.reset();
  const auto lost = ask(board, poll);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->kind, FrameKind::kLost);
  EXPECT_EQ(lost->session, kSession);
  EXPECT_EQ(identify(board), kIdentity);
}

TEST(SimulatedBoard, IsLostWhileUnplugged) {
  SimulatedBoard board;
  identify(board);
  board.unplug();
  std::array<std::uint8_t, 1> byte;
  EXPECT_THROW(board.read(byte, 1ms), ChannelLost);
  EXPECT_THROW(board.write(byte), ChannelLost);
  EXPECT_FALSE(board.reopen());
  board.plug();
  EXPECT_THROW(board.write(byte), ChannelLost);
  EXPECT_TRUE(board.reopen());
  EXPECT_EQ(ask(board, {.kind = FrameKind::kPoll, .session = kSession})->kind, FrameKind::kLost);
  EXPECT_EQ(identify(board), kIdentity);
}

}  // namespace
}  // namespace emax
