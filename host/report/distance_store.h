#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/files/nameless_file.h"

namespace emax {

// The distances of all points of a cloud: in memory where there is room, else in a file without a
// name, 8 bytes a point.
class DistanceStore {
 public:
  // `cloud`: its name for messages.
  DistanceStore(std::uint64_t points, std::uint64_t memory_bytes, const std::string& cloud);

  // Those of the points `first`, `first` + 1, ... Several threads may put at a time.
  void put(std::uint64_t first, std::span<const double> distances);
  // Gives all in the order of the points, some at a time.
  void read(const std::function<void(std::span<const double>)>& take) const;

  bool is_in_memory() const { return !file_; }
  // All of them, where they are in memory.
  std::vector<double> release() { return std::move(held_); }

 private:
  std::uint64_t points_;
  std::vector<double> held_;
  std::optional<NamelessFile> file_;
};

}  // namespace emax
