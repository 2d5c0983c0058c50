#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/chain/bounded_chain.h"
#include "host/chain/stage_cache.h"
#include "host/parameters/chain_parameters.h"
#include "host/reconstruct/reconstruction.h"

namespace emax {

// Kept of each stage, in bytes: a surface of the 437,645 points of the dragon takes 21 MB.
inline constexpr std::size_t kStageCacheBytes = std::size_t{1} << 27;

// The chain from one cloud to decimated meshes: moving least squares -> reconstruct -> fill holes
// -> decimate; or, in place of the last, see kNoDecimator. Results of the stages before decimation
// are kept by the values of their genes, so candidates that differ in decimation alone share them.
class Chain {
 public:
  explicit Chain(std::vector<Point> points, DecimationBound bound = {},
                 std::size_t cache_bytes = kStageCacheBytes);

  // A pure function of points, bound, settings and rival, unless `options.stopped` becomes true
  // while the bounded decimator works, which then gives the mesh at hand. Throws Error when a stage
  // leaves nothing or a parameter has no value.
  ChainResult run(const ChainSettings& settings, const RunOptions& options = {});

  std::size_t clouds() const { return clouds_.made(); }
  std::size_t reconstructions() const { return reconstructions_.made(); }
  std::size_t surfaces() const { return surfaces_.made(); }
  std::size_t planes_found() const { return planes_.made(); }

 private:
  struct MovedCloud {
    std::vector<Point> points;
    std::size_t size_in_bytes() const { return points.size() * sizeof(Point); }
  };
  struct Reconstructed : Reconstruction {
    std::size_t size_in_bytes() const { return emax::size_in_bytes(mesh); }
  };
  // What a decimator starts from.
  struct Surface {
    TriangleMesh mesh;
    std::size_t reconstruction_triangles, unmeshed_points;
    SurfaceVerdict verdict;  // of the bounded decimator
    std::size_t size_in_bytes() const { return emax::size_in_bytes(mesh); }
  };

  struct FoundPlanes {
    std::shared_ptr<const PlaneParts> parts;
    std::size_t size_in_bytes() const;
  };

  std::span<const Point> cloud(const ChainSettings& settings);
  double spacing();
  const Reconstruction& reconstruct(const ChainSettings& settings, StageSeconds& seconds,
                                    std::size_t threads);
  const Surface& surface(const ChainSettings& settings, StageSeconds& seconds, std::size_t threads);

  // The planes of the points that count, for a mesh within epsilon; nullptr for a candidate that
  // follows none.
  std::shared_ptr<const PlaneParts> planes(const ChainSettings& settings, std::size_t threads);

  std::vector<Point> points_;
  std::optional<double> spacing_;  // of the points, once asked for
  BoundedStage bounded_;
  StageCache<ParameterValues, MovedCloud> clouds_;
  StageCache<StageKey, Reconstructed> reconstructions_;
  StageCache<std::pair<StageKey, std::string>, Surface> surfaces_;  // and the decimator
  StageCache<ParameterValues, FoundPlanes> planes_;
};

}  // namespace emax
