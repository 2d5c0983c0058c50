#include "host/chain/bounded_chain.h"

#include <algorithm>
#include <cmath>

#include "host/parameters/registry.h"
#include "host/surface/drop_components.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr double kInside = 1 - 1e-9;  // of a bound: where no rounding leads beyond it

// Certified: an upper bound on the distance where it keeps the limit, a lower one otherwise.
double bounded_distance(MeshView from, const ExactMesh& to, double limit) {
  const SurfaceDistance decided = decided_distance(from, to, limit);
  if (decided.within(limit)) return decided.upper;
  constexpr double kPrecision = 0.05;  // enough to compare candidates that fail
  SurfaceDistanceOptions measure;
  measure.relative = kPrecision;
  const SurfaceDistance measured = surface_distance(from, to, measure);
  return std::max({decided.lower, measured.lower, std::nextafter(limit, HUGE_VAL)});
}

bool equal(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

}  // namespace

BoundedStage::BoundedStage(std::span<const Point> points, DecimationBound bound)
    : bound_(std::move(bound)), kept_(points_without(points, bound_.outliers)) {
  if (!two_sided()) return;
  exact_reference_.emplace(bound_.reference.view());
  topology_ = topology_of(bound_.reference.view());
}

TriangleMesh BoundedStage::without_needless(TriangleMesh surface) const {
  if (!(bound_.epsilon > 0)) return surface;
  return drop_needless_components(std::move(surface), kept_, bound_.epsilon / 2);
}

TriangleMesh BoundedStage::start(const TriangleMesh& surface) const {
  if (!(bound_.epsilon > 0)) throw Error("the bounded decimator was given no bound");
  return reference_surface(surface, kept_, joining_distance(1, bound_.epsilon)).mesh;
}

bool BoundedStage::made_reference(const ChainSettings& settings) const {
  return two_sided() && keeps_bound(settings.decimator) && surface_key(settings) == bound_.made_by;
}

SurfaceVerdict BoundedStage::judge(const TriangleMesh& mesh) const {
  SurfaceVerdict verdict;
  if (!two_sided() || equal(mesh, bound_.reference)) return verdict;
  const MeshTopology topology = topology_of(mesh.view());
  const auto difference = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  verdict.topology_difference = difference(topology.components, topology_.components) +
                                difference(topology.border_loops, topology_.border_loops) +
                                difference(topology.genus, topology_.genus);
  verdict.back_distance = bounded_distance(mesh.view(), *exact_reference_, bound_.epsilon_back);
  verdict.reference_distance =
      bounded_distance(bound_.reference.view(), ExactMesh(mesh.view()), bound_.epsilon);
  return verdict;
}

bool BoundedStage::keeps_bounds(const SurfaceVerdict& verdict) const {
  return !two_sided() ||
         (verdict.topology_difference == 0 && verdict.back_distance <= bound_.epsilon_back &&
          verdict.reference_distance <= bound_.epsilon);
}

DecimatedMesh Bounded::run(const TriangleMesh& start, const ParameterValues& values,
                           const BoundedStage& stage, const RunOptions& options) {
  using Effort = DecimationSettings::Effort;
  static_assert(static_cast<Effort>(kDeepEffort) == Effort::kDeep);
  const DecimationBound& bound = stage.bound();
  DecimationSettings settings;
  settings.epsilon = bound.epsilon;
  settings.epsilon_back = bound.epsilon_back;
  settings.two_sided = stage.two_sided();
  settings.effort = static_cast<Effort>(values.at(kEffort));
  settings.normal_cosine = values.at(kNormalCosine);
  settings.flatness = values.at(kFlatness);
  settings.interrupted = options.stopped;
  settings.rival = options.rival;
  settings.threads = options.threads;
  settings.planes = options.planes;
  settings.spread_on_planes =
      values.find(PlaneFeatures::kSpread).value_or(false) && !EMAX_FAULT(kForgetsSpread);
  const TriangleMesh& reference = stage.two_sided() ? bound.reference : start;
  DecimatedMesh made = BoundedDecimator(reference, stage.kept()).run(start, settings);
  if (stage.two_sided()) return made;
  made.mesh = drop_needless_components(std::move(made.mesh), stage.kept(), kInside * bound.epsilon);
  return made;
}

}  // namespace emax
