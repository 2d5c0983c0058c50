#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace emax {

// Items, some of which need others; the choice is to have the greatest profit.
struct ClosureProblem {
  std::vector<long> profit;                                // by item; negative is a cost
  std::vector<std::pair<std::size_t, std::size_t>> needs;  // choosing the first needs the second
};

// The smallest of the sets of greatest profit, as a flag for each item; no item if no set has a
// profit above 0. By minimum cut, O(profit * (items + needs)) at worst.
std::vector<bool> max_closure(const ClosureProblem& problem);

}  // namespace emax
