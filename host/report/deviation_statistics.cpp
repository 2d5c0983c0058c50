#include "host/report/deviation_statistics.h"

#include <algorithm>
#include <cmath>

namespace emax {
namespace {

constexpr std::size_t kBinsOfASide = 20;

double part(std::size_t some, std::size_t all) {
  return static_cast<double>(some) / static_cast<double>(all);
}

}  // namespace

DeviationStatistics deviation_statistics(std::span<const double> deviations,
                                         std::optional<double> epsilon) {
  DeviationStatistics s;
  s.count = deviations.size();
  const auto [least, greatest] = std::ranges::minmax(deviations);
  s.min = least;
  s.max = greatest;
  const auto n = static_cast<double>(s.count);
  double sum = 0, squares = 0, about_mean = 0;
  for (const double d : deviations) {
    sum += d;
    squares += d * d;
  }
  s.mean = sum / n;
  s.rms = std::sqrt(squares / n);
  for (const double d : deviations) about_mean += (d - s.mean) * (d - s.mean);
  s.sigma = std::sqrt(about_mean / n);
  for (std::size_t k = 0; k < s.within_sigma.size(); ++k) {
    const double reach = static_cast<double>(k + 1) * s.sigma;
    const auto within =
        std::ranges::count_if(deviations, [&](double d) { return std::abs(d - s.mean) <= reach; });
    s.within_sigma[k] = part(static_cast<std::size_t>(within), s.count);
  }
  if (!epsilon) return s;
  std::array<std::size_t, 3> counts = {};
  for (const double d : deviations) ++counts[d > *epsilon ? 0 : d >= -*epsilon ? 1 : 2];
  s.against_epsilon = counts;
  return s;
}

DeviationHistogram deviation_histogram(std::span<const double> deviations, bool are_signed,
                                       double reach) {
  DeviationHistogram histogram;
  const std::size_t bins = are_signed ? 2 * kBinsOfASide : kBinsOfASide;
  const double from = are_signed ? -reach : 0;
  for (std::size_t i = 0; i <= bins; ++i) {
    // Exact at both ends and, with signs, at 0.
    const double share = static_cast<double>(i) / static_cast<double>(bins);
    histogram.edges.push_back((1 - share) * from + share * reach);
  }
  histogram.counts.resize(bins);
  for (const double d : deviations) {
    if (d < histogram.edges.front()) {
      ++histogram.below;
    } else if (d > histogram.edges.back()) {
      ++histogram.above;
    } else {
      const auto next = std::ranges::upper_bound(histogram.edges, d);
      const auto bin = static_cast<std::size_t>(next - histogram.edges.begin()) - 1;
      ++histogram.counts[std::min(bin, bins - 1)];
    }
  }
  return histogram;
}

}  // namespace emax
