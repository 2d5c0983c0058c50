// The board's side of the link in software. Whatever came, it takes a reset and answers rightly
// after it.
#include <algorithm>
#include <array>
#include <utility>

#include "sw_model/protocol/cpp_device.h"
#include "testbench/link/link_twin.h"
#include "tests/fuzz/link_bytes.h"

namespace emax::fuzz {
namespace {

using namespace std::chrono_literals;

// The least host. It keeps the frames that come.
class Host {
 public:
  void send(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      bytes = bytes.subspan(board_.write(bytes));
      listen(50us);
    }
  }

  void listen(std::chrono::microseconds time) {
    std::array<std::uint8_t, 256> bytes;
    for (const auto end = board_.now() + time; board_.now() < end;) {
      reader_.add(std::span(bytes).first(board_.read(bytes, time)));
      while (auto frame = reader_.next()) frames_.push_back(*std::move(frame));
    }
  }

  // The frames since the last call.
  std::vector<Frame> take_frames() { return std::exchange(frames_, {}); }

 private:
  LinkedBoardTwin board_{[] { return std::make_unique<CppDevice>(); }, {.byte_time = 1us}};
  FrameReader reader_;
  std::vector<Frame> frames_;
};

}  // namespace

void read(Input input) {
  constexpr std::uint16_t kOld = 0x1234, kNew = 0x1235;
  Host host;
  LinkItems items(input);
  while (const auto item = items.next(kOld)) host.send(*item);
  host.listen(10ms);  // longer than any silence within a frame
  host.take_frames();

  host.send(encode({.kind = FrameKind::kReset, .session = kNew}));
  host.send(encode(
      {.kind = FrameKind::kData, .session = kNew, .payload = {command_header(kIdentify, 0)}}));
  host.listen(1ms);
  const std::vector<Frame> frames = host.take_frames();
  const auto answer = std::ranges::find(frames, FrameKind::kData, &Frame::kind);
  require(answer != frames.end() && answer->session == kNew, "the board answers in a new session");
  const std::vector<Word> identity = {command_header(kIdentify, kAnswerIdentity),
                                      kKernelVersion,
                                      kMaxBlockPoints,
                                      kRecordWords,
                                      1,
                                      0};
  require(answer->payload == identity, "the board answers with its identity");
}

std::vector<std::string> seeds() {
  return {frame_item({.kind = FrameKind::kReset}) +
          frame_item({.kind = FrameKind::kData, .payload = {command_header(kIdentify, 0)}}) +
          frame_item({.kind = FrameKind::kPoll, .expected = 1})};
}

}  // namespace emax::fuzz
