#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hls/kernel/word.h"

namespace emax {

// Counts of a device's work; empty where nothing is measured.
struct DeviceCounters {
  std::uint64_t blocks = 0;
  std::uint64_t pairs = 0;
  std::uint64_t words_in = 0;   // to the device
  std::uint64_t words_out = 0;  // from the device
  // Of a device with a filter: the pairs that the filter met, the points of their blocks, and those
  // of them that it left to the kernel, whose pairs are `pairs`.
  std::optional<std::uint64_t> filtered_pairs, filtered_points, points_left;
  std::optional<std::uint64_t> cycles, busy, stalled, idle, resends;
  // Of a board whose time is predicted: from the first word to the last answer that was taken.
  std::optional<double> predicted_seconds;
  bool began_again = false;  // the device lost its work once, and its earlier counts with it
};

// Takes command words and gives answer words (hls/kernel/command_words.h).
class Device {
 public:
  virtual ~Device() = default;

  virtual std::string name() const = 0;
  virtual void send(std::span<const Word> words) = 0;
  // Waits for exactly words.size() answer words. Throws Error when they cannot come.
  virtual void receive(std::span<Word> words) = 0;
  // Cycle counts only; the driver counts blocks, pairs and words.
  virtual DeviceCounters counters() const = 0;
};

}  // namespace emax
