#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host/decimate/bounded_decimation.h"

namespace emax {

// The decimation of one reference, cut at any bounds and effort: meshes under bounds that grow
// by a factor of sqrt(2) from far below the points' spacing are made once, each by collapses from
// the one before it, and a cut goes on from the coarsest that is well below its own bounds. What a
// cut gives is as BoundedDecimator promises, and depends on the settings alone, not on the cuts
// before; its bytes are not those of a direct run. Not for concurrent use.
class DecimationSequence {
 public:
  // Both outlive the sequence.
  DecimationSequence(const TriangleMesh& reference, std::span<const Point> cloud);

  // A cut that is interrupted while meshes are made gives the last one.
  DecimatedMesh cut(const DecimationSettings& settings);

  // Meshes made so far, of the one- and two-sided kind.
  std::size_t levels() const { return meshes_[0].size() + meshes_[1].size(); }

 private:
  BoundedDecimator decimator_;
  const TriangleMesh& reference_;
  double finest_ = 0, reach_ = 0;
  std::array<std::vector<TriangleMesh>, 2> meshes_;
};

}  // namespace emax
