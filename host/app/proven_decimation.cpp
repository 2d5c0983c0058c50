#include "host/app/proven_decimation.h"

#include <algorithm>
#include <string>
#include <utility>

#include "host/parameters/registry.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

std::vector<std::uint32_t> farthest_beyond(const Scan& scan, MeshView mesh, double epsilon,
                                           std::size_t excludable, std::size_t threads) {
  if (excludable == 0) return {};
  constexpr std::size_t kPiece = 4096;
  const ExactMesh exact(mesh);
  using Beyond = std::vector<std::pair<double, std::uint32_t>>;
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
  beyond.resize(std::min(beyond.size(), excludable));
  std::vector<std::uint32_t> points;
  for (const auto& [distance, i] : beyond) points.push_back(i);
  std::ranges::sort(points);
  return points;
}

}  // namespace

KeptPoints choose_kept(const Scan& scan, MeshView mesh, double epsilon, std::size_t excludable,
                       std::size_t threads) {
  KeptPoints kept;
  kept.outliers = farthest_beyond(scan, mesh, epsilon, excludable, threads);
  for (std::uint32_t i = 0; i < scan.cloud.points.size(); ++i) {
    if (std::ranges::binary_search(kept.outliers, i)) continue;
    kept.points.push_back(scan.cloud.points[i]);
    kept.index.push_back(i);
  }
  return kept;
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
