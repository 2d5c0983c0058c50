// The receiver of the link, which hunts for frames in any bytes.
#include <algorithm>

#include "sw_model/base/error.h"
#include "tests/fuzz/link_bytes.h"

namespace emax::fuzz {
namespace {

constexpr std::uint16_t kSession = 0x1234;

struct Reading {
  std::vector<Frame> frames;
  std::uint64_t dropped = 0;

  bool operator==(const Reading&) const = default;
};

Reading read_in_parts(std::span<const std::uint8_t> bytes, std::size_t part) {
  FrameReader reader;
  Reading reading;
  while (!bytes.empty()) {
    const auto now = bytes.first(std::min(part, bytes.size()));
    reader.add(now);
    while (auto frame = reader.next()) reading.frames.push_back(*std::move(frame));
    bytes = bytes.subspan(now.size());
  }
  reading.dropped = reader.dropped();
  reader.abandon();
  while (reader.next()) {
  }
  return reading;
}

}  // namespace

void read(Input input) {
  LinkItems items(input);
  std::vector<std::uint8_t> bytes;
  while (const auto item = items.next(kSession)) {
    bytes.insert(bytes.end(), item->begin(), item->end());
  }
  const Reading whole = read_in_parts(bytes, bytes.size() + 1);
  require(read_in_parts(bytes, 1) == whole, "the cuts of the stream change nothing");
  auto at = bytes.begin();
  for (const Frame& frame : whole.frames) {
    const auto sent = encode(frame);
    at = std::search(at, bytes.end(), sent.begin(), sent.end());
    require(at != bytes.end(), "a frame that was read is in the stream, with its CRC");
    at += static_cast<std::ptrdiff_t>(sent.size());
  }
}

std::vector<std::string> seeds() {
  return {frame_item({.kind = FrameKind::kData, .payload = {1, 2, 3}}) +
              frame_item({.kind = FrameKind::kPoll}),
          std::string{0, 3, 0x4d, static_cast<char>(0xe5), 2} +
              frame_item({.kind = FrameKind::kStatus, .credit = 200})};
}

}  // namespace emax::fuzz
