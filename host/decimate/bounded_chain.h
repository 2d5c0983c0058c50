#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/decimate/back_bound.h"
#include "host/decimate/bounded_decimation.h"
#include "host/decimate/decimation_bound.h"
#include "host/parameters/parameter_spec.h"
#include "sw_model/surface_distance.h"

namespace emax {

// The bounded decimator as the end of the chain, for the surfaces of one cloud.
class BoundedStage {
 public:
  BoundedStage(std::span<const Point> points, DecimationBound bound);
  BoundedStage(const BoundedStage&) = delete;  // the exact reference refers to the bound's
  BoundedStage& operator=(const BoundedStage&) = delete;

  bool two_sided() const { return bound_.epsilon_back > 0; }

  // drop_needless_components() at half of epsilon, which leaves decimation room; as it is where the
  // run fixed no bound.
  TriangleMesh without_needless(TriangleMesh surface) const;

  // What decimation starts from: the surface as a manifold, under a two-sided bound without the
  // triangles that stray from the reference, and with the points inserted that are far from it, or
  // covered by pieces of the reference where that cannot be.
  // Throws what reference_surface() throws under a one-sided bound, what manifold_part() throws
  // under a two-sided one, and Error where all of it strays and where the run fixed no bound.
  TriangleMesh start(const TriangleMesh& surface) const;

  // `values` holds P_D. Without the components that no point needs any more.
  TriangleMesh decimate(const TriangleMesh& start, const ParameterValues& values) const;

  // A certified upper bound on the distance of the mesh from the reference where it keeps
  // epsilon_back, and a lower one otherwise; 0 when the bound is one-sided.
  double back_distance(const TriangleMesh& mesh) const;

  // Likewise of the distance of the reference, the inside of its triangles included, from the mesh,
  // whose bound is epsilon.
  double reference_distance(const TriangleMesh& mesh) const;

 private:
  DecimationBound bound_;
  std::vector<Point> kept_;  // points that are no outliers
  std::optional<BackBound> back_;
  std::optional<ExactMesh> exact_reference_;
};

}  // namespace emax
