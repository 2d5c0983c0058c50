#pragma once

#include <deque>
#include <span>
#include <utility>

#include "host/decimate/chain_parameters.h"
#include "host/reconstruct/reconstruction.h"

namespace emax {

// The last few reconstructions of one cloud by their exact parameters: candidates that differ in
// decimation alone share one. Reconstruction is a pure function, so no result depends on the cache.
class StageCache {
 public:
  explicit StageCache(std::size_t capacity = 4) : capacity_(capacity) {}

  // Throws what the reconstruction throws; that is not kept.
  const Reconstruction& reconstruct(std::span<const Point> points, const ChainSettings& settings);

  std::size_t size() const { return recent_.size(); }

 private:
  using Key = std::pair<std::string, ParameterValues>;

  std::size_t capacity_;
  std::deque<std::pair<Key, Reconstruction>> recent_;  // most recent first
};

// reconstruct -> fill holes -> decimate. `cache` always goes with the same points.
// Throws Error when a stage leaves nothing or a parameter has no value.
ChainResult run_chain(std::span<const Point> points, const ChainSettings& settings,
                      StageCache& cache);

}  // namespace emax
