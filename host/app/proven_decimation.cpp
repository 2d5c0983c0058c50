#include "host/app/proven_decimation.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "host/parameters/registry.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr int kTries = 4;  // to make room

using Beyond = std::vector<std::pair<double, std::uint32_t>>;  // -distance, index

// The farthest first.
Beyond points_beyond(const Scan& scan, MeshView mesh, double epsilon, std::size_t threads) {
  constexpr std::size_t kPiece = 4096;
  const ExactMesh exact(mesh);
  std::vector<Beyond> of_thread(std::max<std::size_t>(threads, 1));
  in_pieces(threads, scan.cloud.points.size(), kPiece,
            [&](std::size_t thread, std::size_t first, std::size_t last) {
              for (std::size_t i = first; i < last; ++i) {
                const double distance = exact.distance(scan.cloud.points[i]).upper;
                if (distance <= epsilon) continue;
                of_thread[thread].emplace_back(-distance, static_cast<std::uint32_t>(i));
              }
            });
  Beyond beyond;
  for (const Beyond& some : of_thread) beyond.insert(beyond.end(), some.begin(), some.end());
  std::ranges::sort(beyond);
  return beyond;
}

KeptPoints without(const Scan& scan, std::span<const Beyond::value_type> outliers) {
  KeptPoints kept;
  for (const auto& [distance, i] : outliers) kept.outliers.push_back(i);
  std::ranges::sort(kept.outliers);
  for (std::uint32_t i = 0; i < scan.cloud.points.size(); ++i) {
    if (std::ranges::binary_search(kept.outliers, i)) continue;
    kept.points.push_back(scan.cloud.points[i]);
    kept.index.push_back(i);
  }
  return kept;
}

// Of those that were not joined to the reference.
std::size_t count_beyond(const GivenReference& reference, std::span<const Point> points,
                         double epsilon) {
  const std::vector<std::uint32_t>& left_out = reference.surface.left_out;
  if (left_out.empty()) return 0;
  const ExactMesh exact(reference.surface.mesh.view());
  return static_cast<std::size_t>(std::ranges::count_if(
      left_out, [&](std::uint32_t p) { return exact.distance(points[p]).upper > epsilon; }));
}

}  // namespace

std::optional<std::size_t> fewer_excluded(std::size_t excluded, std::size_t missed,
                                          std::size_t excludable, int tries) {
  if (excluded + missed <= excludable || tries == kTries) return std::nullopt;
  const std::size_t released = 2 * (excluded + missed - excludable);  // not all can be joined
  if (released > excluded) return std::nullopt;
  return excluded - released;
}

KeptReference reference_with_room(const Scan& scan, MeshView mesh, double epsilon,
                                  std::size_t excludable, std::size_t threads,
                                  const std::function<GivenReference(const KeptPoints&)>& make) {
  Beyond beyond;
  if (excludable > 0) beyond = points_beyond(scan, mesh, epsilon, threads);
  std::size_t excluded = std::min(beyond.size(), excludable);
  for (int tries = 0;; ++tries) {
    KeptReference found;
    found.kept = without(scan, std::span(beyond).first(excluded));
    found.reference = make(found.kept);
    const std::size_t missed = count_beyond(found.reference, found.kept.points, epsilon);
    const std::optional<std::size_t> fewer = fewer_excluded(excluded, missed, excludable, tries);
    if (!fewer) return found;
    excluded = *fewer;
  }
}

CertifiedDecimation decimate_scan(const TriangleMesh& reference, const Scan& scan,
                                  const KeptPoints& kept,
                                  const CertifiedDecimationSettings& settings) {
  CertifiedDecimation made = decimate_certified(reference, kept.points, settings);
  if (kept.outliers.empty()) return made;
  std::vector<std::uint32_t> excluded = kept.outliers;
  for (const std::uint32_t i : made.points.excluded) excluded.push_back(kept.index[i]);
  std::ranges::sort(excluded);
  made.points = certify(scan.cloud.points, made.mesh.view(), excluded);
  return made;
}

ProvenMesh proofs_of(const CertifiedDecimation& made, const Scan& scan) {
  ProvenMesh proven;
  proven.validity = made.validity;
  proven.topology = topology_of(made.mesh.view());
  proven.points = made.points;
  proven.kernel = kernel_error(scan, made.mesh.view(), made.points.excluded);
  return proven;
}

ReferenceBound bound_of(const CertifiedDecimation& made, double epsilon_back, ReferenceFile& file,
                        const std::optional<double>& points_to_reference) {
  ReferenceBound bound;
  bound.epsilon_back = epsilon_back;
  bound.mesh_to_reference = made.mesh_to_reference->upper;
  bound.reference_to_mesh = made.reference_to_mesh->upper;
  if (points_to_reference) {
    file.describe_measured(bound, *points_to_reference);
  } else {
    file.describe(bound, made.points.excluded);
  }
  return bound;
}

ChainSettings chain_of(const DecimationSettings& settings) {
  ChainSettings chain = {"none", std::string(Bounded::kName), {}};
  ParameterValues& values = chain.parameters;
  values.set(Bounded::kEffort, static_cast<int>(settings.effort));
  values.set(Bounded::kFeatureAngle, settings.feature_angle);
  if (settings.objective == DecimationSettings::Objective::kHoppe)
    values.set(Bounded::kHoppe, true);
  return chain;
}

}  // namespace emax
