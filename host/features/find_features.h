#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/features/region.h"
#include "host/geometry/scan_estimate.h"

namespace emax {

enum class PlaneMethod { kGrowing, kHough };

// The regions of a cloud.
struct Features {
  FeatureOptions options;  // as they were taken
  // The greatest support first; equal ones in the order of their first points.
  std::vector<Region> regions;
};

struct FeatureSearch {
  PlaneMethod planes = PlaneMethod::kGrowing;
  bool curved = true;                    // cylinders and spheres, too
  std::optional<double> max_error = {};  // the band; nothing: suggested_tolerance()
  std::size_t least_support = FeatureOptions{}.least_support;
  std::uint64_t seed = FeatureOptions{}.seed;
  std::size_t threads = 1;
  std::function<void()> check = [] {};  // as that of FeatureOptions
};

// Planes, cylinders and spheres of a scan, with their outlines. Points that coincide count as one,
// and are all in its region. None for fewer than `least_support` points, or for points without a
// distance. A pure function of the arguments but the threads. O(n log n).
Features find_features(std::span<const Point> cloud, const FeatureSearch& search);

}  // namespace emax
