#include "host/measure/piece_measurement.h"

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
  const PreparedCloud cloud(piece, normalization_);
  if (every_pair_) {
    SimdEvaluator evaluator;
    return brute_force_nearest(cloud, *every_pair_, evaluator, {.interrupted = interrupted});
  }
  ErrorEngine engine(cloud, {.interrupted = interrupted});
  return engine.squared_distances(mesh_);
}

}  // namespace emax
