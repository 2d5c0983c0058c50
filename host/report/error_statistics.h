#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace emax {

inline constexpr std::array<double, 5> kUsualQuantiles = {50, 90, 95, 99, 99.9};  // percent
inline constexpr std::size_t kHistogramBins = 16;
inline constexpr double kHistogramReach =
    99.9;  // percent, so that outliers do not flatten the rest

// Summary numbers of many distances.
struct ErrorStatistics {
  struct Quantile {
    double percent, value;
  };
  struct Bin {
    double up_to;  // inclusive
    std::size_t count;
  };

  std::size_t count = 0;
  double maximum = 0, mean = 0, rms = 0;
  std::vector<Quantile> quantiles;  // in the order of the request
  std::vector<Bin> histogram;       // equal bins up to the quantile kHistogramReach, and one beyond
  std::optional<std::size_t> exceeding;  // above the limit
};

// Gives many distances in order, some at a time, as often as it is called.
using DistancePieces =
    std::function<void(const std::function<void(std::span<const double>)>& take)>;

// Statistics of at least one finite distance >= 0; quantiles by nearest rank (nearest_rank.h). Sums
// are taken in the given order, so equal input gives equal output, and all numbers are exact
// however many distances there are: they are asked for seven times. O(n) time; 64 KiB for
// each quantile and thread.
ErrorStatistics statistics_of(const DistancePieces& distances, std::span<const double> percents,
                              std::optional<double> limit = std::nullopt);
ErrorStatistics statistics_of(std::span<const double> distances, std::span<const double> percents,
                              std::optional<double> limit = std::nullopt);

}  // namespace emax
