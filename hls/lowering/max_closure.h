#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace emax {

// A choice of items, some of which need others, that has the greatest profit.
struct ClosureProblem {
  std::vector<long> profit;                                // by item; negative is a cost
  std::vector<std::pair<std::size_t, std::size_t>> needs;  // choosing the first needs the second
};

// The smallest of the sets of greatest profit, as a flag by item; empty choice if none has a profit
// above 0. By minimum cut, O(profit * (items + needs)) at worst.
std::vector<bool> max_closure(const ClosureProblem& problem);

}  // namespace emax
