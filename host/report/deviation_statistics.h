#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace emax {

// Summary numbers of deviations, with or without signs, in the cloud's unit.
struct DeviationStatistics {
  std::size_t count = 0;
  double min = 0, max = 0, mean = 0, rms = 0;
  double sigma = 0;                         // standard deviation about the mean
  std::array<double, 3> within_sigma = {};  // shares within 1, 2 and 3 sigma of the mean
  // Counts of d > epsilon, |d| <= epsilon and d < -epsilon, if there is an epsilon.
  std::optional<std::array<std::size_t, 3>> against_epsilon;
};

// Of at least one finite deviation. Sums are taken in the given order. O(n).
DeviationStatistics deviation_statistics(std::span<const double> deviations,
                                         std::optional<double> epsilon);

// Bins of equal width over [-reach, reach], or [0, reach] where deviations have no sign. A bin
// holds its lower edge, the last one both.
struct DeviationHistogram {
  std::vector<double> edges;        // ascending, one more than bins
  std::vector<std::size_t> counts;  // of each bin
  std::size_t below = 0, above = 0;
};

// `reach` above 0. O(n).
DeviationHistogram deviation_histogram(std::span<const double> deviations, bool are_signed,
                                       double reach);

}  // namespace emax
