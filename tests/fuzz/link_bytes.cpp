#include "tests/fuzz/link_bytes.h"

namespace emax::fuzz {

std::uint8_t LinkItems::byte() {
  if (left_.empty()) return 0;
  const std::uint8_t first = left_.front();
  left_ = left_.subspan(1);
  return first;
}

std::uint16_t LinkItems::two_bytes() {
  const std::uint16_t low = byte();
  return static_cast<std::uint16_t>(low | byte() << 8);
}

std::optional<std::vector<std::uint8_t>> LinkItems::next(std::uint16_t session) {
  if (left_.empty()) return std::nullopt;
  const int kind = byte() % 4;
  if (kind == 0) {
    std::vector<std::uint8_t> bytes(byte());
    for (std::uint8_t& b : bytes) b = byte();
    return bytes;
  }
  if (kind == 3) return std::vector<std::uint8_t>();
  Frame frame = {.kind = FrameKind::kReset, .session = session};
  if (kind == 2) {
    frame.session = two_bytes();
    frame.version = byte();
  }
  frame.kind = static_cast<FrameKind>(byte());
  frame.sequence = byte();
  frame.expected = byte();
  frame.credit = byte();
  frame.payload.resize(byte());
  for (Word& word : frame.payload) {
    const Word low = two_bytes();
    word = low | Word{two_bytes()} << 16;
  }
  return encode(frame);
}

std::string frame_item(const Frame& frame) {
  std::string item = {1,
                      static_cast<char>(frame.kind),
                      static_cast<char>(frame.sequence),
                      static_cast<char>(frame.expected),
                      static_cast<char>(frame.credit),
                      static_cast<char>(frame.payload.size())};
  for (const Word word : frame.payload) {
    for (int shift = 0; shift < 32; shift += 8) item += static_cast<char>(word >> shift);
  }
  return item;
}

}  // namespace emax::fuzz
