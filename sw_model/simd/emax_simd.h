#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "hls/kernel/triangle_record.h"

namespace emax {

// Points as a structure of arrays, in normalised units.
struct PointArrays {
  std::vector<float> x, y, z;

  std::size_t size() const { return x.size(); }
  void clear();
  void push_back(const Vector3<float>& p);
};

// nearest[i] = min(nearest[i], d^2 of points[i] and every record), as binary32 bits. Runs the
// kernel's own source, vectorised over points, with the processor's flushing turned on. Gives the
// bits of the model for finite input. O(points * records); nearest.size() == points.size().
class SimdTarget {
 public:
  using Update = void (*)(const PointArrays&, std::span<const TriangleRecord<float>>,
                          std::span<std::uint32_t>);
  SimdTarget(std::string_view name, Update update) : name_(name), update_(update) {}

  std::string_view name() const { return name_; }
  void update_nearest(const PointArrays& points, std::span<const TriangleRecord<float>> records,
                      std::span<std::uint32_t> nearest) const;

 private:
  std::string_view name_;
  Update update_;
};

// The targets this processor runs, best first; the last is the plain one.
std::span<const SimdTarget> simd_targets();

}  // namespace emax
