#include "sw_model/model/fixed_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Greater than every squared distance: of a point that has met no triangle.
template <int kBits>
FilterSquare<kBits> none() {
  using Square = FilterSquare<kBits>;
  return Square::from_raw(fixed_greatest(Square::format().width));
}

// In filter units.
template <int kBits>
double filter_distance(FilterSquare<kBits> squared) {
  return squared == none<kBits>() ? kInfinity : std::sqrt(static_cast<double>(squared));
}

// The greatest exponent up to `most` with which value * 2^exponent is at most `limit`.
int fitting_exponent(double value, double limit, int most) {
  while (std::ldexp(value, most) > limit) --most;
  return most;
}

// The kernel's minimum of a point over all triangles.
std::uint32_t nearest_bits(const Vector3<float>& point,
                           std::span<const TriangleRecord<float>> records) {
  return nearest_squared_bits({&point, 1}, records).front();
}

}  // namespace

int filter_exponent(std::span<const Vector3<float>> points,
                    std::span<const TriangleRecord<float>> records, int bits) {
  double extent = 0;
  for (const Vector3<float>& p : points) extent = std::max(extent, greatest_coordinate(p));
  const double of_cloud = extent;
  double longest = 0;
  for (const TriangleRecord<float>& record : records) {
    const double v1 = greatest_coordinate(record.v1);
    const double length = static_cast<double>(record.length12);
    if (v1 > 2 * of_cloud || length > 4 * of_cloud) continue;
    extent = std::max(extent, v1);
    longest = std::max(longest, length);
  }
  constexpr int kMost = 1;
  return fitting_exponent(longest, 1, fitting_exponent(extent, 2 - filter_step(bits), kMost));
}

double filter_upper_bound(double f, double longest, int bits) {
  const double step = filter_step(bits);
  if (!EMAX_FAULT(kFilterTrustsSaturated) && f >= 1 - kFilterUnreachedSteps * step) {
    return kInfinity;
  }
  if (EMAX_FAULT(kFilterWithoutMargin)) return f;
  return f +
         step * (kFilterErrorSteps + kFilterErrorOfDistance * f + kFilterErrorOfLength * longest);
}

template <int kBits>
FilterBounds filter_bounds(std::span<const Vector3<float>> points,
                           std::span<const TriangleRecord<float>> records) {
  const int exponent = filter_exponent(points, records, kBits);
  std::vector<Vector3<FilterScalar<kBits>>> fixed_points;
  fixed_points.reserve(points.size());
  for (const Vector3<float>& p : points) fixed_points.push_back(filter_point<kBits>(p, exponent));

  FilterBounds bounds;
  std::vector<FilterSquare<kBits>> nearest(points.size(), none<kBits>());
  double longest = 0;
  for (const TriangleRecord<float>& record : records) {
    const auto fixed = filter_record<kBits>(record, exponent);
    if (!fixed) {
      ++bounds.triangles_without;
      continue;
    }
    longest = std::max(longest, std::ldexp(static_cast<double>(record.length12), exponent));
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = std::min(nearest[i], filter_squared_distance<kBits>(fixed_points[i], *fixed));
    }
  }
  for (const FilterSquare<kBits> squared : nearest) {
    const double f = filter_distance<kBits>(squared);
    bounds.distance.push_back(std::ldexp(f, -exponent));
    bounds.upper.push_back(std::ldexp(filter_upper_bound(f, longest, kBits), -exponent));
  }
  return bounds;
}

template <int kBits>
FilteredEmax filtered_emax(std::span<const Vector3<float>> points,
                           std::span<const TriangleRecord<float>> records) {
  if (points.empty()) throw std::invalid_argument("an empty cloud has no worst point");
  if (records.empty()) throw std::invalid_argument("a mesh without triangles has no distance");
  const FilterBounds bounds = filter_bounds<kBits>(points, records);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(
      order, [&](std::uint32_t a, std::uint32_t b) { return bounds.upper[a] > bounds.upper[b]; });

  FilteredEmax filtered{{0, order.front()},
                        {points.size(), 0, records.size(), bounds.triangles_without}};
  EmaxResult& worst = filtered.result;
  for (const std::uint32_t i : order) {
    // An equal minimum may belong to a lower index.
    if (bounds.upper[i] < distance_of(worst.squared_bits)) break;
    ++filtered.counts.points_left;
    const std::uint32_t bits = nearest_bits(points[i], records);
    if (bits > worst.squared_bits || (bits == worst.squared_bits && i < worst.worst_point)) {
      worst = {bits, i};
    }
  }
  return filtered;
}

template FilterBounds filter_bounds<18>(std::span<const Vector3<float>>,
                                        std::span<const TriangleRecord<float>>);
template FilterBounds filter_bounds<16>(std::span<const Vector3<float>>,
                                        std::span<const TriangleRecord<float>>);
template FilterBounds filter_bounds<14>(std::span<const Vector3<float>>,
                                        std::span<const TriangleRecord<float>>);
template FilteredEmax filtered_emax<18>(std::span<const Vector3<float>>,
                                        std::span<const TriangleRecord<float>>);
template FilteredEmax filtered_emax<16>(std::span<const Vector3<float>>,
                                        std::span<const TriangleRecord<float>>);
template FilteredEmax filtered_emax<14>(std::span<const Vector3<float>>,
                                        std::span<const TriangleRecord<float>>);

}  // namespace emax
