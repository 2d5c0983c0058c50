#include "sw_model/protocol/frames.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "sw_model/base/crc32.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

std::vector<Frame> frames_of(FrameReader& reader) {
  std::vector<Frame> frames;
  while (auto frame = reader.next()) frames.push_back(*frame);
  return frames;
}

std::vector<Frame> frames_in(const Bytes& bytes) {
  FrameReader reader;
  reader.add(bytes);
  return frames_of(reader);
}

Frame data_frame(std::size_t words, std::uint64_t seed) {
  test::Random random(seed);
  Frame frame = {.kind = FrameKind::kData,
                 .session = static_cast<std::uint16_t>(random.bits()),
                 .sequence = static_cast<std::uint8_t>(random.bits()),
                 .expected = static_cast<std::uint8_t>(random.bits()),
                 .credit = static_cast<std::uint16_t>(random.bits())};
  for (std::size_t i = 0; i < words; ++i) frame.payload.push_back(static_cast<Word>(random.bits()));
  return frame;
}

const Frame kFollower = {.kind = FrameKind::kStatus, .session = 7, .expected = 3, .credit = 2048};

TEST(Frames, HaveTheirBytesWhereTheProtocolPutsThem) {
  const Frame frame = {.kind = FrameKind::kData,
                       .session = 0x1234,
                       .sequence = 5,
                       .expected = 6,
                       .credit = 0xabcd,
                       .payload = {0x01020304}};
  Bytes bytes = encode(frame);
  const Bytes expected = {0x4d, 0xe5, 2, 2, 0x34, 0x12, 5, 6, 1, 0, 0xcd, 0xab, 4, 3, 2, 1};
  ASSERT_EQ(bytes.size(), expected.size() + 4);
  EXPECT_EQ(Bytes(bytes.begin(), bytes.end() - 4), expected);
  // The CRC of a message with its CRC behind it is the same for every message.
  EXPECT_EQ(crc32(bytes), 0x2144df1cu);
}

TEST(Frames, ComeBackFromAnyCutOfTheirBytes) {
  test::Random random(31);
  std::vector<Frame> sent;
  Bytes bytes;
  for (const std::size_t words : {0, 1, 2, 255, 256, 0, 17}) {
    sent.push_back(data_frame(words, 100 + words));
    append(bytes, encode(sent.back()));
  }
  for (int round = 0; round < 50; ++round) {
    FrameReader reader;
    std::vector<Frame> taken;
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t count =
          std::min<std::size_t>(random.below(round < 10 ? 3 : 400), bytes.size() - at);
      reader.add(std::span(bytes).subspan(at, count));
      at += count;
      for (const Frame& frame : frames_of(reader)) taken.push_back(frame);
    }
    EXPECT_EQ(taken, sent);
    EXPECT_EQ(reader.dropped(), 0u);
  }
  EXPECT_THROW(encode(data_frame(257, 1)), std::invalid_argument);
}

// The damaged frame is never given, and the one behind it always is.
TEST(Frames, DamageOfEverySingleBitIsDetected) {
  for (const std::size_t words : {0, 3}) {
    const Frame frame = data_frame(words, 32);
    for (std::size_t bit = 0; bit < 8 * encode(frame).size(); ++bit) {
      Bytes bytes = encode(frame);
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
      append(bytes, encode(kFollower));
      FrameReader reader;
      reader.add(bytes);
      std::vector<Frame> taken = frames_of(reader);
      // A greater length is awaited until the reader is told that nothing more comes.
      reader.abandon();
      for (const Frame& more : frames_of(reader)) taken.push_back(more);
      EXPECT_EQ(taken, std::vector{kFollower}) << "bit " << bit << " of " << words << " words";
      EXPECT_EQ(reader.dropped(), bit < 16 ? 0u : 1u) << "bit " << bit;
    }
  }
}

TEST(Frames, AreFoundInGarbage) {
  test::Random random(33);
  for (int round = 0; round < 300; ++round) {
    Bytes bytes;
    std::vector<Frame> sent;
    FrameReader reader;
    std::vector<Frame> taken;
    for (std::uint64_t i = 0; i < 4; ++i) {
      for (std::uint32_t count = random.below(40); count > 0; --count) {
        // Often a sync, or the first byte of one.
        bytes.push_back(random.below(3) == 0 ? kSync[random.below(2)]
                                             : static_cast<std::uint8_t>(random.bits()));
      }
      sent.push_back(data_frame(random.below(20), 1000 + i));
      append(bytes, encode(sent.back()));
    }
    reader.add(bytes);
    for (int i = 0; i < 60; ++i) {
      for (const Frame& frame : frames_of(reader)) taken.push_back(frame);
      reader.abandon();
    }
    EXPECT_EQ(taken, sent) << "round " << round;
  }
}

TEST(Frames, ALengthAbove256IsDroppedAtOnce) {
  Bytes bytes = encode(data_frame(256, 34));
  bytes[8] = 1;  // 257
  bytes.resize(kFrameHeaderBytes);
  append(bytes, encode(kFollower));
  EXPECT_EQ(frames_in(bytes), std::vector{kFollower});
}

TEST(Frames, ASyncInsideAPayloadStartsNothing) {
  Frame frame = data_frame(8, 35);
  const Bytes inner = encode(kFollower);
  for (std::size_t i = 0; i < inner.size() / 4; ++i) {
    frame.payload[i] =
        static_cast<Word>(inner[4 * i] | inner[4 * i + 1] << 8 | inner[4 * i + 2] << 16) |
        static_cast<Word>(inner[4 * i + 3]) << 24;
  }
  Bytes bytes = encode(frame);
  append(bytes, encode(kFollower));
  EXPECT_EQ(frames_in(bytes), (std::vector{frame, kFollower}));
}

TEST(Frames, ATruncatedFrameCostsOnlyItself) {
  const Bytes whole = encode(data_frame(5, 36));
  for (std::size_t kept = 0; kept < whole.size(); ++kept) {
    Bytes bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(kept));
    append(bytes, encode(kFollower));
    append(bytes, encode(kFollower));
    FrameReader reader;
    reader.add(bytes);
    std::vector<Frame> taken = frames_of(reader);
    reader.abandon();
    for (const Frame& frame : frames_of(reader)) taken.push_back(frame);
    EXPECT_EQ(taken, (std::vector{kFollower, kFollower})) << kept << " bytes kept";
  }
}

TEST(Frames, NothingToAbandonIsNoFault) {
  FrameReader reader;
  reader.abandon();
  reader.add(Bytes{1, 2, kSync[0]});
  EXPECT_EQ(reader.next(), std::nullopt);
  reader.abandon();  // half a sync may still become one
  EXPECT_EQ(reader.dropped(), 0u);
  Bytes bytes = encode(kFollower);
  reader.add(std::span(bytes).subspan(1));
  EXPECT_EQ(reader.next(), kFollower);
}

}  // namespace
}  // namespace emax
