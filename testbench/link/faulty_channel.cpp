#include "testbench/link/faulty_channel.h"

#include <algorithm>
#include <array>
#include <utility>

namespace emax {
namespace {

constexpr std::size_t kBuffer = 4096;
constexpr std::uint32_t kLongestBurst = 64;

}  // namespace

std::string FaultCounts::text() const {
  std::string text;
  const auto add = [&text](std::uint64_t count, const char* what) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(flips, "bits flipped");
  add(drops, "bytes dropped");
  add(doubles, "bytes doubled");
  add(bursts, "bursts");
  add(swaps, "frames out of order");
  add(garbage, "bytes of garbage");
  add(stalls, "stalls");
  add(unplugs, "times unplugged");
  return text.empty() ? "no faults" : text;
}

FaultyChannel::FaultyChannel(ByteChannel& inner, std::uint64_t seed, const ByteFaults& to_board,
                             const ByteFaults& to_host)
    : inner_(inner), random_(seed), to_board_{to_board}, to_host_{to_host} {}

void FaultyChannel::add_garbage(std::size_t count) {
  counts_.garbage += count;
  for (Direction* direction : {&to_board_, &to_host_}) {
    for (std::size_t i = 0; i < count; ++i) {
      // Garbage often contains the start of a frame.
      direction->bytes.push_back(random_.one_in(4) ? kSync[i % 2]
                                                   : static_cast<std::uint8_t>(random_.word()));
    }
  }
}

void FaultyChannel::stall(Duration time) {
  ++counts_.stalls;
  stalled_until_ = now() + time;
}

void FaultyChannel::unplug(Duration time) {
  ++counts_.unplugs;
  back_at_ = now() + time;
}

void FaultyChannel::after_bytes(std::uint64_t count, std::function<void()> action) {
  actions_.push_back({count, std::move(action)});
}

std::size_t FaultyChannel::write(std::span<const std::uint8_t> bytes) {
  require_plugged();
  if (to_board_.bytes.size() >= kBuffer) return 0;
  bytes = bytes.first(std::min(bytes.size(), kBuffer - to_board_.bytes.size()));
  pass(bytes, to_board_);
  bytes_to_board_ += bytes.size();
  flush();
  for (std::size_t i = 0; i < actions_.size(); ++i) {
    if (actions_[i].bytes > bytes_to_board_) continue;
    const Action action = std::move(actions_[i]);
    actions_.erase(actions_.begin() + static_cast<std::ptrdiff_t>(i--));
    action.act();
  }
  return bytes.size();
}

std::size_t FaultyChannel::read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) {
  require_plugged();
  const Duration end = now() + wait;
  do {
    flush();
    const auto left = std::chrono::ceil<std::chrono::microseconds>(end - now());
    std::array<std::uint8_t, 256> arrived;
    pass(std::span(arrived).first(inner_.read(arrived, std::max(left, {}))), to_host_);
  } while ((stalled() || to_host_.bytes.empty()) && now() < end);
  if (stalled()) return 0;
  const std::size_t count = std::min(bytes.size(), to_host_.bytes.size());
  const auto stop = to_host_.bytes.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(to_host_.bytes.begin(), stop, bytes.begin());
  to_host_.bytes.erase(to_host_.bytes.begin(), stop);
  return count;
}

bool FaultyChannel::reopen() {
  absence_ += std::chrono::milliseconds(100);
  if (back_at_ && now() < *back_at_) return false;
  back_at_.reset();
  to_board_ = {to_board_.faults};
  to_host_ = {to_host_.faults};
  return inner_.reopen();
}

void FaultyChannel::require_plugged() {
  if (back_at_) throw ChannelLost("channel " + name() + " is unplugged");
}

void FaultyChannel::flush() {
  while (!stalled() && !to_board_.bytes.empty()) {
    std::array<std::uint8_t, 256> chunk;
    const std::size_t count = std::min(chunk.size(), to_board_.bytes.size());
    std::copy_n(to_board_.bytes.begin(), count, chunk.begin());
    const std::size_t taken = inner_.write(std::span(chunk).first(count));
    if (taken == 0) return;
    to_board_.bytes.erase(to_board_.bytes.begin(),
                          to_board_.bytes.begin() + static_cast<std::ptrdiff_t>(taken));
  }
}

void FaultyChannel::pass(std::span<const std::uint8_t> bytes, Direction& direction) {
  if (direction.faults.swap > 0) {
    swap_frames(bytes, direction);
  } else {
    damage(bytes, direction);
  }
}

void FaultyChannel::swap_frames(std::span<const std::uint8_t> bytes, Direction& direction) {
  direction.reader.add(bytes);
  while (auto frame = direction.reader.next()) {
    if (!direction.held && happens(direction.faults.swap)) {
      ++counts_.swaps;
      direction.held = std::move(frame);
      direction.held_for = 1 + random_.below(3);
      continue;
    }
    damage(encode(*frame), direction);
    if (direction.held && --direction.held_for == 0) {
      damage(encode(*std::exchange(direction.held, std::nullopt)), direction);
    }
  }
}

void FaultyChannel::damage(std::span<const std::uint8_t> bytes, Direction& direction) {
  for (std::uint8_t byte : bytes) {
    if (direction.burst_left == 0 && happens(direction.faults.burst)) {
      ++counts_.bursts;
      direction.burst_left = 1 + random_.below(kLongestBurst);
    }
    if (direction.burst_left > 0) {
      --direction.burst_left;
      byte = static_cast<std::uint8_t>(random_.word());
    }
    if (happens(direction.faults.flip)) {
      ++counts_.flips;
      byte ^= static_cast<std::uint8_t>(1u << random_.below(8));
    }
    if (happens(direction.faults.drop)) {
      ++counts_.drops;
      continue;
    }
    direction.bytes.push_back(byte);
    if (happens(direction.faults.twice)) {
      ++counts_.doubles;
      direction.bytes.push_back(byte);
    }
  }
}

bool FaultyChannel::happens(double probability) {
  return probability > 0 && random_.uniform(0, 1) < probability;
}

}  // namespace emax
