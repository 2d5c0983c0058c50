// The host's side of the link, whose board answers with anything.
#include <algorithm>
#include <deque>

#include "host/device/link_device.h"
#include "sw_model/protocol/commands.h"
#include "tests/fuzz/link_bytes.h"

namespace emax::fuzz {
namespace {

using namespace std::chrono_literals;

// Bytes that come from the input. Time passes only here.
class AnyBoard : public ByteChannel {
 public:
  explicit AnyBoard(Input input) : items_(input) {}

  std::string name() const override { return "any"; }

  std::size_t write(std::span<const std::uint8_t> bytes) override {
    host_.add(bytes);
    while (const auto frame = host_.next()) session_ = frame->session;
    return bytes.size();
  }

  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) override {
    time_ += 1us;
    if (ready_.empty()) {
      const auto item = items_.next(session_);
      if (!item || item->empty()) time_ += wait;
      if (item) ready_.assign(item->begin(), item->end());
    }
    const std::size_t count = std::min(bytes.size(), ready_.size());
    const auto end = ready_.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(ready_.begin(), end, bytes.begin());
    ready_.erase(ready_.begin(), end);
    return count;
  }

  std::chrono::steady_clock::duration now() override { return time_; }
  bool reopen() override { return true; }

 private:
  LinkItems items_;
  FrameReader host_;
  std::uint16_t session_ = 0;
  std::deque<std::uint8_t> ready_;
  std::chrono::steady_clock::duration time_{};
};

}  // namespace

void read(Input input) {
  constexpr LinkLimits kLimits = {
      .repeat = 10ms, .silence = 50ms, .standstill = 200ms, .absence = 100ms, .recoveries = 4};
  LinkDevice device(std::make_unique<AnyBoard>(input), kLimits);
  require_compatible(device);
  const Vector3<float> points[] = {{0, 0, 0}, {1, 0, 0}};
  std::vector<Word> words;
  append_load_points(words, points);
  append_reduce(words, true);
  device.send(words);
  const ReduceAnswer answer = receive_reduce(device, std::size(points), true);
  require(answer.worst < std::size(points), "the worst point is one of the block's");
  require(answer.points_squared_bits.size() == std::size(points), "each point has its answer");
  DeviceCounters counters;
  ask_cycles(device, counters);
}

std::vector<std::string> seeds() {
  const auto data = [](std::uint8_t sequence, std::vector<Word> words) {
    return frame_item({.kind = FrameKind::kData,
                       .sequence = sequence,
                       .expected = static_cast<std::uint8_t>(sequence + 1),
                       .credit = 255,
                       .payload = std::move(words)});
  };
  const std::string reset = frame_item({.kind = FrameKind::kStatus, .credit = 255});
  const std::string identity = data(0, {command_header(kIdentify, kAnswerIdentity), kKernelVersion,
                                        kMaxBlockPoints, kRecordWords, 1, 0});
  const std::vector<Word> reduced = {command_header(kReduce, kAnswerWorst + 2), 0x3f800000,
                                     0x40000000, 0x40000000, 1};
  const std::vector<Word> cycles = {command_header(kCounters, kAnswerCounters), 1, 0, 2, 0, 3, 0};
  const std::string lost = frame_item({.kind = FrameKind::kLost});
  return {reset + identity + data(1, reduced) + data(2, cycles),
          reset + identity + lost + reset + data(0, reduced) + data(1, cycles)};
}

}  // namespace emax::fuzz
