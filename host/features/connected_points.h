#pragma once

#include <cstdint>
#include <vector>

#include "host/features/neighbourhoods.h"

namespace emax {

// Sets of points that are connected over the graph of neighbours, which outlives this.
class ConnectedPoints {
 public:
  explicit ConnectedPoints(const Neighbourhoods& near)
      : near_(near), seen_(near.points.size(), 0) {}

  // `first` and all points that `accepts` and that are neighbours of one of the set, in the order
  // in which they are reached. A point that is not accepted is asked again only with `asks_again`.
  // O(n k) for n points of the set.
  template <class Accepts>
  void gather(std::uint32_t first, const Accepts& accepts, std::vector<std::uint32_t>& set,
              bool asks_again = false) {
    begin();
    set.assign(1, first);
    seen_[first] = round_;
    for (std::size_t next = 0; next < set.size(); ++next) {
      for (const std::uint32_t i : near_.of(set[next])) {
        if (seen_[i] == round_) continue;
        const bool accepted = accepts(i);
        if (accepted || !asks_again) seen_[i] = round_;
        if (accepted) set.push_back(i);
      }
    }
  }

 private:
  void begin() {
    if (++round_ != 0) return;
    seen_.assign(seen_.size(), 0);
    round_ = 1;
  }

  const Neighbourhoods& near_;
  std::vector<std::uint32_t> seen_;  // the round that saw the point last
  std::uint32_t round_ = 0;
};

}  // namespace emax
