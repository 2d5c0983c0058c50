#pragma once

#include <algorithm>
#include <vector>

namespace emax {

// Sorts a list and keeps one of equal entries.
template <class T>
void sort_once(std::vector<T>& list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace emax
