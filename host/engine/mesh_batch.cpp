#include "host/engine/mesh_batch.h"

#include <deque>

#include "sw_model/base/parallel.h"

namespace emax {

std::vector<EmaxResult> e_max_of_each(const PreparedCloud& cloud, std::span<const MeshView> meshes,
                                      const EngineOptions& options) {
  EngineOptions of_one = options;
  of_one.threads = std::min<std::size_t>(options.threads, 1);  // 0 stays 0: the engine refuses it
  std::deque<ErrorEngine> engines;
  do {
    engines.emplace_back(cloud, of_one);
    of_one.interrupted = nullptr;
  } while (engines.size() < std::min(options.threads, meshes.size()));

  std::vector<EmaxResult> results(meshes.size());
  in_pieces(engines.size(), meshes.size(), 1,
            [&](std::size_t thread, std::size_t first, std::size_t) {
              ErrorEngine& engine = engines[thread];
              results[first] =
                  engine.e_max(PreparedMesh(meshes[first], cloud.normalization(), engine.target()));
            });
  return results;
}

}  // namespace emax
