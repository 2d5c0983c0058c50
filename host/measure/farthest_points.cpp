#include "host/measure/farthest_points.h"

#include <algorithm>

namespace emax {

void FarthestPoints::add(std::span<const std::uint32_t> squared_bits, const PointNumbers& numbers) {
  if (places_ == 1 && !squared_bits.empty()) {
    const EmaxResult worst = worst_of(squared_bits);
    add({worst.squared_bits, numbers[worst.worst_point]});
    return;
  }
  for (std::size_t i = 0; i < squared_bits.size(); ++i) {
    const bool is_full = farthest_.size() == places_;
    if (!is_full || squared_bits[i] >= farthest_.begin()->first) {
      add({squared_bits[i], numbers[i]});
    }
  }
}

void FarthestPoints::add(EmaxResult point) {
  const std::uint32_t number = point.worst_point;
  const std::uint32_t bits = point.squared_bits;
  if (farthest_.size() == places_ && bits < farthest_.begin()->first) return;
  // A point that gets no place may still be the lowest of its distance. Distances only leave.
  const auto [at, is_new] = lowest_.try_emplace(bits, number);
  if (!is_new) at->second = std::min(at->second, number);
  farthest_.emplace(bits, number);
  if (farthest_.size() <= places_) return;
  farthest_.erase(farthest_.begin());
  lowest_.erase(lowest_.begin(), lowest_.lower_bound(farthest_.begin()->first));
}

FarthestPoints::Excluded FarthestPoints::exclude(std::uint32_t allowed) const {
  Excluded result;
  const auto worst_at = [&](std::uint32_t bits) { return EmaxResult{bits, lowest_.at(bits)}; };
  auto kept = farthest_.rbegin();
  result.all = worst_at(kept->first);
  for (; result.excluded.size() + 1 < places_ && kept->first > allowed; ++kept) {
    result.excluded.push_back(kept->second);
  }
  result.kept = worst_at(kept->first);
  std::ranges::sort(result.excluded);
  return result;
}

}  // namespace emax
