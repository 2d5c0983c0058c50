#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "sw_model/base/point_numbers.h"
#include "sw_model/model/emax_model.h"

namespace emax {

// Which points of a cloud are excluded, and which of the others is the worst, found while the
// cloud's distances come in pieces, in any order. Of equal distances the higher number is excluded
// first, and the lowest number is the worst point. O(log(excludable)) for each of the points that
// are among the farthest so far; about 100 bytes for each point that may be excluded.
class FarthestPoints {
 public:
  explicit FarthestPoints(std::size_t excludable) : places_(excludable + 1) {}

  // The kernel's squared distances of points.
  void add(std::span<const std::uint32_t> squared_bits, const PointNumbers& numbers);
  void add(EmaxResult point);

  struct Excluded {
    EmaxResult kept, all;                 // the worst of the others, and of all
    std::vector<std::uint32_t> excluded;  // numbers, ascending
  };
  // Excludes the farthest points beyond `allowed`, as many as may be. At least one point was added,
  // and more than may be excluded.
  Excluded exclude(std::uint32_t allowed) const;

 private:
  std::size_t places_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> farthest_;  // squared distance and number
  std::map<std::uint32_t, std::uint32_t> lowest_;  // number with each of these distances
};

}  // namespace emax
