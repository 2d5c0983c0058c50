#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/files/nameless_file.h"

namespace emax {

// A value for every point of a cloud: in memory where there is room, else in a file without a name.
template <class Value>
class PointStore {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  // `cloud`: its name for messages.
  PointStore(std::uint64_t points, std::uint64_t memory_bytes, const std::string& cloud)
      : points_(points) {
    if (points <= memory_bytes / sizeof(Value)) {
      held_.resize(static_cast<std::size_t>(points));
    } else {
      file_.emplace(NamedInput{cloud}, "the distances of its points cannot be written");
    }
  }

  // Those of the points `first`, `first` + 1, ... Several threads may put and get those of
  // different points at a time.
  void put(std::uint64_t first, std::span<const Value> values) {
    if (!file_) {
      std::ranges::copy(values, held_.begin() + static_cast<std::ptrdiff_t>(first));
      return;
    }
    file_->write(first * sizeof(Value),
                 {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  }
  // What was put.
  void get(std::uint64_t first, std::span<Value> values) const {
    if (!file_) {
      std::ranges::copy(std::span(held_).subspan(static_cast<std::size_t>(first), values.size()),
                        values.begin());
      return;
    }
    file_->read(first * sizeof(Value),
                {reinterpret_cast<char*>(values.data()), values.size_bytes()});
  }
  // Gives all in the order of the points, some at a time.
  void read(const std::function<void(std::span<const Value>)>& take) const {
    constexpr std::uint64_t kSome = std::uint64_t{1} << 17;
    if (!file_) {
      take(held_);
      return;
    }
    std::vector<Value> some;
    for (std::uint64_t first = 0; first < points_; first += some.size()) {
      some.resize(static_cast<std::size_t>(std::min(kSome, points_ - first)));
      get(first, some);
      take(some);
    }
  }

  bool is_in_memory() const { return !file_; }
  // All of them, where they are in memory.
  std::vector<Value> release() { return std::move(held_); }

 private:
  std::uint64_t points_;
  std::vector<Value> held_;
  std::optional<NamelessFile> file_;
};

using DistanceStore = PointStore<double>;

}  // namespace emax
