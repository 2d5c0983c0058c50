#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sw_model/base/mesh_view.h"
#include "tests/support/scan_bytes.h"

namespace emax::test {

// LAS of these points in steps of 1e-5, with their exact box in its header. Classes are 0 to 6.
inline std::string las_of_points(std::span<const Point> points) {
  constexpr double kFine = 1e-5;
  std::vector<std::array<std::int32_t, 4>> records;
  std::array<std::int32_t, 3> least{}, greatest{};
  for (const Point& p : points) {
    std::array<std::int32_t, 4> record{};
    for (std::size_t k = 0; k < 3; ++k) {
      record[k] = static_cast<std::int32_t>(std::lround(p[static_cast<int>(k)] / kFine));
      least[k] = records.empty() ? record[k] : std::min(least[k], record[k]);
      greatest[k] = records.empty() ? record[k] : std::max(greatest[k], record[k]);
    }
    record[3] = static_cast<std::int32_t>(records.size() % 7);
    records.push_back(record);
  }
  std::string bytes = las_bytes(records);
  for (std::size_t k = 0; k < 3; ++k) {
    put(bytes, 131 + 8 * k, kFine);
    put(bytes, 155 + 8 * k, 0.0);
    put(bytes, 179 + 16 * k, greatest[k] * kFine);
    put(bytes, 187 + 16 * k, least[k] * kFine);
  }
  return bytes;
}

}  // namespace emax::test
