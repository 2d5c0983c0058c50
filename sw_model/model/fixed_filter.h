#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "hls/kernel/filter_words.h"
#include "hls/kernel/fixed.h"
#include "hls/kernel/forms/guarded_edge.h"
#include "hls/kernel/triangle_record.h"
#include "sw_model/model/emax_model.h"

namespace emax {

// The fixed-point filter: most points are decided by the visible-edge form in a few bits
// (hls/kernel/forms/guarded_edge.h), and the kernel meets only those that the filter's proven error
// leaves open. The answer is brute force's, bit for bit. Proof: docs/numerics.md, "The fixed-point
// filter".
//
// Lengths are multiplied by a power of two, so that the filter's numbers lie between -2 and 2:
// these are filter units. Directions are not.

// The filter's numbers have 18 bits unless another width is named, two of them before the point.
constexpr int kFilterBits = 18;
template <int kBits>
using FilterScalar = Fixed<kBits, kBits - 2, Rounding::kHalfUp, Overflow::kSaturate>;
constexpr int kLeastFilterBits = 14, kMostFilterBits = 18;  // for which the error is proven
static_assert(std::is_same_v<FilterScalar<kFilterBits>, FilterNumber>,
              "the filtering core computes with the filter's numbers");
// Steps of filter_step(kBits) squared.
template <int kBits>
using FilterSquare = SumOfProducts<FilterScalar<kBits>>;

inline double filter_step(int bits) { return std::ldexp(1.0, 2 - bits); }

inline double greatest_coordinate(const Vector3<float>& v) {
  return static_cast<double>(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

// The exponent of two that points and triangles are multiplied by: the greatest, up to 1, with
// which every coordinate of a point fits, and V1 and L1 of every triangle near the cloud, that is
// with |V1| at most twice and L1 at most four times the greatest coordinate of a point. Coordinates
// are finite. O(n + m).
int filter_exponent(std::span<const Vector3<float>> points,
                    std::span<const TriangleRecord<float>> records, int bits);

// The nearest number of the filter to a length in normalised units.
template <int kBits>
FilterScalar<kBits> filter_length(float length, int exponent) {
  return FilterScalar<kBits>(std::ldexp(static_cast<double>(length), exponent));
}

template <int kBits>
Vector3<FilterScalar<kBits>> filter_point(const Vector3<float>& point, int exponent) {
  return {filter_length<kBits>(point.x, exponent), filter_length<kBits>(point.y, exponent),
          filter_length<kBits>(point.z, exponent)};
}

// Nothing where the triangle does not fit: a coordinate of V1 beyond the range, or L1 beyond 1. The
// filter goes without such a triangle, which only leaves more points open.
template <int kBits>
std::optional<TriangleRecord<FilterScalar<kBits>>> filter_record(
    const TriangleRecord<float>& record, int exponent) {
  if (std::ldexp(greatest_coordinate(record.v1), exponent) > 2 - filter_step(kBits) ||
      std::ldexp(static_cast<double>(record.length12), exponent) > 1) {
    return std::nullopt;
  }
  TriangleRecord<FilterScalar<kBits>> fixed{};
  for_each_scalar([](FilterScalar<kBits>& to,
                     float from) { to = FilterScalar<kBits>(static_cast<double>(from)); },
                  fixed, record);
  fixed.v1 = filter_point<kBits>(record.v1, exponent);
  fixed.length12 = filter_length<kBits>(record.length12, exponent);
  fixed.edge13.length = filter_length<kBits>(record.edge13.length, exponent);
  fixed.edge23.length = filter_length<kBits>(record.edge23.length, exponent);
  fixed.tag = record.tag;
  return fixed;
}

// The filter's squared distance of one pair, in filter units.
template <int kBits>
FilterSquare<kBits> filter_squared_distance(const Vector3<FilterScalar<kBits>>& point,
                                            const TriangleRecord<FilterScalar<kBits>>& record) {
  static_assert(kLeastFilterBits <= kBits && kBits <= kMostFilterBits,
                "docs/numerics.md proves the error of 14 to 18 bits");
  const bool segment = (record.tag & kSegmentFlag) != 0;
  return squared_distance_guarded(record, segment, point);
}

// What the filter's distance f of a pair proves: the kernel's distance d_k, in filter units, is at
// most this. Infinite where a coordinate may have left the range. L1 is at most `longest`.
//
//   d_k <= f + step (kFilterErrorSteps + kFilterErrorOfDistance f + kFilterErrorOfLength L1)
//
constexpr double kFilterErrorSteps = 4.75;
constexpr double kFilterErrorOfDistance = 3.125;
constexpr double kFilterErrorOfLength = 4.625;
// A pair of which a number saturated has f >= 1 - 16 steps.
constexpr double kFilterUnreachedSteps = 16;
double filter_upper_bound(double f, double longest, int bits);

struct FilterCounts {
  std::size_t points = 0;
  std::size_t points_left = 0;  // met by the kernel, each with all triangles
  std::size_t triangles = 0;
  std::size_t triangles_without = 0;  // do not fit the filter

  bool operator==(const FilterCounts&) const = default;
};

struct FilteredEmax {
  EmaxResult result;
  FilterCounts counts;
};

// emax_model's answer. Every pair that fits meets the filter. The kernel then takes points in the
// order of their upper bounds, greatest first, until an upper bound is below the greatest minimum
// found. Throws std::invalid_argument for no points or no triangles. kBits is 18, 16 or 14.
// O(points * triangles).
template <int kBits = kFilterBits>
FilteredEmax filtered_emax(std::span<const Vector3<float>> points,
                           std::span<const TriangleRecord<float>> records);

// The filter's part of it, in normalised units: the filter's minimum of each point, and an upper
// bound of the kernel's, infinite where nothing is proven.
struct FilterBounds {
  std::vector<double> distance;
  std::vector<double> upper;
  std::size_t triangles_without = 0;
};
template <int kBits>
FilterBounds filter_bounds(std::span<const Vector3<float>> points,
                           std::span<const TriangleRecord<float>> records);

}  // namespace emax
