#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_topology.h"
#include "host/parameters/decimation_bound.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {

// How far a surface is from keeping a two-sided bound; all 0 where the bound is one-sided.
struct SurfaceVerdict {
  // Components, border loops and handles more or fewer than the reference's, added up.
  std::size_t topology_difference = 0;
  // Certified: at most the bound where it is kept, and a lower end of the distance otherwise.
  double back_distance = 0;       // of the surface from the reference
  double reference_distance = 0;  // of the reference, the inside of its triangles too, from it
};

// How the bounded decimator is to work.
struct RunOptions {
  // Polled now and then; true ends the work with the mesh at hand.
  std::function<bool()> stopped = nullptr;
  std::uint64_t rival = 0;                             // DecimationSettings::rival
  std::size_t threads = 1;                             // which change no byte
  std::shared_ptr<const PlaneParts> planes = nullptr;  // DecimationSettings::planes; set by Chain
};

// The bounded decimator as the end of the chain, for the surfaces of one cloud.
class BoundedStage {
 public:
  BoundedStage(std::span<const Point> points, DecimationBound bound);
  BoundedStage(const BoundedStage&) = delete;  // the exact reference refers to the bound's
  BoundedStage& operator=(const BoundedStage&) = delete;

  bool two_sided() const { return bound_.two_sided(); }

  const DecimationBound& bound() const { return bound_; }
  const TriangleMesh& reference() const { return bound_.reference; }
  std::span<const Point> kept() const { return kept_; }  // points that are no outliers
  // Farther than that from a surface a point needs a piece of its own: half of epsilon, which
  // leaves decimation room; 0 where the run fixed no bound.
  double far() const { return bound_.epsilon / 2; }

  // drop_needless_components() at half of epsilon, which leaves decimation room; as it is where the
  // run fixed no bound.
  TriangleMesh without_needless(TriangleMesh surface) const;

  // What decimation starts from: the surface as a manifold, with the points inserted that are far
  // from it. Throws what reference_surface() throws, and Error where the run fixed no bound.
  TriangleMesh start(const TriangleMesh& surface) const;

  // Whether the reference is what the settings reconstruct, mended and closed beyond what a
  // candidate is, and so the better start.
  bool made_reference(const ChainSettings& settings) const;

  SurfaceVerdict judge(const TriangleMesh& mesh) const;
  bool keeps_bounds(const SurfaceVerdict& verdict) const;

 private:
  DecimationBound bound_;
  std::vector<Point> kept_;  // points that are no outliers
  std::optional<ExactMesh> exact_reference_;
  MeshTopology topology_;  // of the reference
};

}  // namespace emax
