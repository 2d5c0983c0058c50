#include "sw_model/protocol/frames.h"

#include <algorithm>
#include <stdexcept>

#include "sw_model/base/crc32.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

void append_number(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t number(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = (value << 8) | bytes[i];
  return value;
}

}  // namespace

std::vector<std::uint8_t> encode(const Frame& frame) {
  if (frame.payload.size() > kMaxFrameWords) {
    throw std::invalid_argument("a frame holds at most 256 words");
  }
  std::vector<std::uint8_t> bytes(std::begin(kSync), std::end(kSync));
  bytes.reserve(kFrameHeaderBytes + 4 * frame.payload.size() + kFrameCrcBytes);
  bytes.push_back(frame.version);
  bytes.push_back(static_cast<std::uint8_t>(frame.kind));
  append_number(bytes, frame.session, 2);
  bytes.push_back(frame.sequence);
  bytes.push_back(frame.expected);
  append_number(bytes, static_cast<std::uint32_t>(frame.payload.size()), 2);
  append_number(bytes, frame.credit, 2);
  for (const Word word : frame.payload) append_number(bytes, word, 4);
  append_number(bytes, crc32(bytes), 4);
  return bytes;
}

void FrameReader::add(std::span<const std::uint8_t> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(start_));
  start_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<Frame> FrameReader::next() {
  while (hunt()) {
    const auto bytes = rest();
    if (bytes.size() < kFrameHeaderBytes) return std::nullopt;
    const std::size_t words = number(bytes.subspan(8, 2));
    if (words > kMaxFrameWords) {
      drop();
      continue;
    }
    const std::size_t checked = kFrameHeaderBytes + 4 * words;
    if (bytes.size() < checked + kFrameCrcBytes) return std::nullopt;
    const bool is_whole =
        crc32(bytes.first(checked)) == number(bytes.subspan(checked, kFrameCrcBytes));
    if (!is_whole && !EMAX_FAULT(kSkipsCrc)) {
      drop();
      continue;
    }
    Frame frame = {.kind = static_cast<FrameKind>(bytes[3]),
                   .session = static_cast<std::uint16_t>(number(bytes.subspan(4, 2))),
                   .sequence = bytes[6],
                   .expected = bytes[7],
                   .credit = static_cast<std::uint16_t>(number(bytes.subspan(10, 2))),
                   .payload = std::vector<Word>(words),
                   .version = bytes[2]};
    for (std::size_t i = 0; i < words; ++i) {
      frame.payload[i] = number(bytes.subspan(kFrameHeaderBytes + 4 * i, 4));
    }
    start_ += checked + kFrameCrcBytes;
    return frame;
  }
  return std::nullopt;
}

void FrameReader::abandon() {
  if (hunt() && rest().size() >= std::size(kSync)) drop();
}

// Moves to the next sync bytes, or to a first sync byte at the end; false where there is neither.
bool FrameReader::hunt() {
  const auto bytes = rest();
  const auto found = std::search(bytes.begin(), bytes.end(), std::begin(kSync), std::end(kSync));
  start_ += static_cast<std::size_t>(found - bytes.begin());
  if (found == bytes.end() && !bytes.empty() && bytes.back() == kSync[0]) --start_;
  return start_ < bytes_.size();
}

void FrameReader::drop() {
  start_ += std::size(kSync);
  ++dropped_;
}

}  // namespace emax
