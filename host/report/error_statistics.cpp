#include "host/report/error_statistics.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include "host/engine/nearest_rank.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

// Distances are not negative, so that they are ordered as the bits of their numbers.
std::uint64_t bits_of(double distance) { return std::bit_cast<std::uint64_t>(distance + 0.0); }

constexpr unsigned kDigitBits = 13;
constexpr unsigned kDigits = 5;                       // five have 65 bits
constexpr std::size_t kPiece = std::size_t{1} << 16;  // distances that a thread counts at a time

// A number that is sought by its rank, of which some leading digits are known.
struct Sought {
  std::size_t rank;  // from 1, among the numbers with these digits
  std::uint64_t digits = 0;
};

using DigitCounts = std::array<std::size_t, std::size_t{1} << kDigitBits>;

// How many distances begin with each prefix, by the digit that follows it; `below`: bits behind
// that digit. All threads count.
std::vector<DigitCounts> counts_of_digits(const DistancePieces& distances,
                                          const std::vector<std::uint64_t>& prefixes,
                                          unsigned below) {
  const std::size_t threads = processor_threads();
  std::vector<std::vector<DigitCounts>> by_thread(threads);
  distances([&](std::span<const double> piece) {
    in_pieces(threads, piece.size(), kPiece,
              [&](std::size_t thread, std::size_t first, std::size_t last) {
                std::vector<DigitCounts>& counts = by_thread[thread];
                if (counts.empty()) counts.resize(prefixes.size());
                for (const double distance : piece.subspan(first, last - first)) {
                  const std::uint64_t digits = bits_of(distance) >> below;
                  const std::uint64_t prefix = digits >> kDigitBits;
                  const auto at = std::ranges::lower_bound(prefixes, prefix);
                  if (at == prefixes.end() || *at != prefix) continue;
                  ++counts[static_cast<std::size_t>(at - prefixes.begin())]
                          [digits & ((std::uint64_t{1} << kDigitBits) - 1)];
                }
              });
  });
  std::vector<DigitCounts> sum(prefixes.size());
  for (const std::vector<DigitCounts>& counts : by_thread) {
    for (std::size_t p = 0; p < counts.size(); ++p) {
      std::ranges::transform(sum[p], counts[p], sum[p].begin(), std::plus<>());
    }
  }
  return sum;
}

// The distances of the given ranks, from 1 in ascending order: their digits one after the other, by
// counting how many distances have which next digit.
std::vector<double> distances_of_ranks(const DistancePieces& distances,
                                       const std::vector<std::size_t>& ranks) {
  std::vector<Sought> sought;
  for (const std::size_t rank : ranks) sought.push_back({rank});
  for (unsigned known = 0; known < kDigits; ++known) {
    std::vector<std::uint64_t> prefixes;
    for (const Sought& s : sought) prefixes.push_back(s.digits);
    std::ranges::sort(prefixes);
    prefixes.erase(std::unique(prefixes.begin(), prefixes.end()), prefixes.end());
    const unsigned below = kDigitBits * (kDigits - 1 - known);
    const std::vector<DigitCounts> counts = counts_of_digits(distances, prefixes, below);
    for (Sought& s : sought) {
      const auto at = std::ranges::lower_bound(prefixes, s.digits) - prefixes.begin();
      const auto& of_digit = counts[static_cast<std::size_t>(at)];
      std::uint64_t digit = 0;
      for (; s.rank > of_digit[digit]; ++digit) s.rank -= of_digit[digit];
      s.digits = s.digits << kDigitBits | digit;
    }
  }
  std::vector<double> found;
  for (const Sought& s : sought) found.push_back(std::bit_cast<double>(s.digits));
  return found;
}

// Equal bins up to `reach`, and one up to `maximum`; and how many distances exceed the limit.
void count(const DistancePieces& distances, double reach, std::optional<double> limit,
           ErrorStatistics& s) {
  constexpr std::size_t kEqual = kHistogramBins - 1;
  for (std::size_t i = 1; i < kEqual; ++i) {
    s.histogram.push_back({reach * static_cast<double>(i) / static_cast<double>(kEqual), 0});
  }
  s.histogram.push_back({reach, 0});
  s.histogram.push_back({s.maximum, 0});
  if (limit) s.exceeding = 0;
  distances([&](std::span<const double> piece) {
    for (const double distance : piece) {
      ++std::ranges::lower_bound(s.histogram, distance, {}, &ErrorStatistics::Bin::up_to)->count;
      if (limit && distance > *limit) ++*s.exceeding;
    }
  });
}

}  // namespace

ErrorStatistics statistics_of(const DistancePieces& distances, std::span<const double> percents,
                              std::optional<double> limit) {
  ErrorStatistics s;
  double sum = 0, squares = 0;
  distances([&](std::span<const double> piece) {
    for (const double d : piece) {
      sum += d;
      squares += d * d;
      s.maximum = std::max(s.maximum, d);
    }
    s.count += piece.size();
  });
  const double number = static_cast<double>(s.count);
  s.mean = std::min(sum / number, s.maximum);
  s.rms = std::min(std::sqrt(squares / number), s.maximum);
  std::vector<std::size_t> ranks = {nearest_rank(kHistogramReach / 100, s.count)};
  for (const double percent : percents) ranks.push_back(nearest_rank(percent / 100, s.count));
  const std::vector<double> values = distances_of_ranks(distances, ranks);
  for (std::size_t i = 0; i < percents.size(); ++i) {
    s.quantiles.push_back({percents[i], values[i + 1]});
  }
  count(distances, values.front(), limit, s);
  return s;
}

ErrorStatistics statistics_of(std::span<const double> distances, std::span<const double> percents,
                              std::optional<double> limit) {
  return statistics_of([&](const auto& take) { take(distances); }, percents, limit);
}

}  // namespace emax
