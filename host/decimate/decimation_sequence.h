#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host/decimate/bounded_decimation.h"

namespace emax {

// Cuts the decimation of one reference at any bounds and effort. A series of meshes is made once,
// each by collapses from the one before. Their bounds grow by a factor of sqrt(2) from far below
// the points' spacing. A cut starts from the coarsest mesh that is well below its own bounds. A
// cut's result is as BoundedDecimator promises. It depends on the settings alone, not on earlier
// cuts; its bytes are not those of a direct run. Not for concurrent use.
class DecimationSequence {
 public:
  // Both must outlive the sequence.
  DecimationSequence(const TriangleMesh& reference, std::span<const Point> cloud);

  // If a cut is interrupted while meshes are made, the result is the mesh reached so far.
  DecimatedMesh cut(const DecimationSettings& settings);

  // Number of meshes made so far, one-sided and two-sided ones together.
  std::size_t levels() const { return meshes_[0].size() + meshes_[1].size(); }

 private:
  BoundedDecimator decimator_;
  const TriangleMesh& reference_;
  double finest_ = 0, reach_ = 0;
  std::array<std::vector<TriangleMesh>, 2> meshes_;
};

}  // namespace emax
