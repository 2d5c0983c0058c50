#include "host/report/error_statistics.h"

#include <algorithm>
#include <cmath>

#include "host/engine/nearest_rank.h"

namespace emax {
namespace {

double quantile_of(std::span<const double> sorted, double percent) {
  return sorted[nearest_rank(percent / 100, sorted.size()) - 1];
}

std::vector<ErrorStatistics::Bin> histogram_of(std::span<const double> sorted) {
  constexpr std::size_t kEqual = kHistogramBins - 1;
  const double reach = quantile_of(sorted, kHistogramReach);
  std::vector<ErrorStatistics::Bin> bins;
  std::size_t below = 0;
  const auto add = [&](double up_to) {
    const std::size_t end = static_cast<std::size_t>(
        std::upper_bound(sorted.begin(), sorted.end(), up_to) - sorted.begin());
    bins.push_back({up_to, end - below});
    below = end;
  };
  for (std::size_t i = 1; i < kEqual; ++i) {
    add(reach * static_cast<double>(i) / static_cast<double>(kEqual));
  }
  add(reach);
  add(sorted.back());
  return bins;
}

}  // namespace

ErrorStatistics statistics_of(std::span<const double> distances, std::span<const double> percents,
                              std::optional<double> limit) {
  ErrorStatistics s;
  s.count = distances.size();
  std::vector<double> sorted(distances.begin(), distances.end());
  std::ranges::sort(sorted);
  s.maximum = sorted.back();
  double sum = 0, squares = 0;
  for (const double d : distances) {
    sum += d;
    squares += d * d;
  }
  const double count = static_cast<double>(s.count);
  s.mean = std::min(sum / count, s.maximum);
  s.rms = std::min(std::sqrt(squares / count), s.maximum);
  for (const double percent : percents) {
    s.quantiles.push_back({percent, quantile_of(sorted, percent)});
  }
  s.histogram = histogram_of(sorted);
  if (limit) {
    s.exceeding = static_cast<std::size_t>(sorted.end() -
                                           std::upper_bound(sorted.begin(), sorted.end(), *limit));
  }
  return s;
}

}  // namespace emax
