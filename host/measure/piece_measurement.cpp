#include "host/measure/piece_measurement.h"

#include <algorithm>

#include "host/block_search/block_search.h"
#include "host/block_search/simd_evaluator.h"
#include "host/engine/error_engine.h"

namespace emax {

PieceMeasurement::PieceMeasurement(MeshView mesh, const Normalization& normalization,
                                   bool brute_force, std::size_t threads)
    : normalization_(normalization), mesh_(mesh, normalization, engine_targets().front(), threads) {
  if (brute_force) every_pair_.emplace(mesh, normalization);
}

std::vector<std::uint32_t> PieceMeasurement::squared_distances(
    std::span<const Point> piece, const std::function<bool()>& interrupted) const {
  std::vector<std::uint32_t> squared_bits(piece.size(), kNothingMet);
  lower(piece, squared_bits, interrupted);
  return squared_bits;
}

void PieceMeasurement::lower(std::span<const Point> piece, std::span<std::uint32_t> squared_bits,
                             const std::function<bool()>& interrupted) const {
  const PreparedCloud cloud(piece, normalization_);
  if (!every_pair_) {
    ErrorEngine(cloud, {.interrupted = interrupted}).lower(mesh_, squared_bits);
    return;
  }
  SimdEvaluator evaluator;
  const std::vector<std::uint32_t> found =
      brute_force_nearest(cloud, *every_pair_, evaluator, {.interrupted = interrupted});
  std::ranges::transform(squared_bits, found, squared_bits.begin(),
                         [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); });
}

}  // namespace emax
