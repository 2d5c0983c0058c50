#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

namespace emax {

// The last results of one stage of the chain by their exact parameters, bounded in bytes. Stages
// are pure functions, so no result depends on the cache. `Value` has size_in_bytes().
template <typename Key, typename Value>
class StageCache {
 public:
  explicit StageCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // The value of `key`, by `make()` unless it is kept; valid until the next call. What `make`
  // throws passes through, and nothing is kept. The last value is kept whatever its size.
  template <typename Make>
  const Value& get(const Key& key, Make make) {
    const auto known = std::find_if(recent_.begin(), recent_.end(),
                                    [&](const auto& entry) { return entry.first == key; });
    if (known != recent_.end()) {
      std::rotate(recent_.begin(), known, known + 1);
      return recent_.front().second;
    }
    recent_.emplace_front(key, make());
    ++made_;
    bytes_ += recent_.front().second.size_in_bytes();
    while (bytes_ > most_bytes_ && recent_.size() > 1) {
      bytes_ -= recent_.back().second.size_in_bytes();
      recent_.pop_back();
    }
    return recent_.front().second;
  }

  std::size_t size() const { return recent_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t made() const { return made_; }  // values that were not kept when asked for

 private:
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::size_t made_ = 0;
  std::deque<std::pair<Key, Value>> recent_;  // most recent first
};

}  // namespace emax
