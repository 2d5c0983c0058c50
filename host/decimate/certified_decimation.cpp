#include "host/decimate/certified_decimation.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <vector>

#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr int kRestarts = 3;              // with smaller bounds
constexpr double kFirstReduction = 1e-3;  // of the bounds; later ones are kGrowth times the last
constexpr double kGrowth = 8;

class Attempts {
 public:
  Attempts(const TriangleMesh& reference, const ProvenCloud& cloud,
           const CertifiedDecimationSettings& settings, const Decimate& decimate)
      : reference_(reference),
        exact_reference_(reference.view()),
        own_validity_(check_mesh(reference.view(), settings.decimation.threads)),
        cloud_(cloud),
        settings_(settings),
        decimate_(decimate),
        epsilon_(settings.decimation.epsilon),
        epsilon_back_(settings.decimation.epsilon_back > 0 ? settings.decimation.epsilon_back
                                                           : epsilon_) {}

  CertifiedDecimation run() {
    const double rounding = storage_displacement(reference_, settings_.storage);
    double reduction = 2 * rounding / std::min(epsilon_, epsilon_back_);
    for (int restart = 0; restart <= kRestarts; ++restart) {
      if (holds(decimated(reduction))) return std::move(result_);
      ++result_.repairs;
      reduction = std::max(kFirstReduction, kGrowth * reduction);
      if (reduction > 0.5) break;
    }
    // A decimator that was interrupted did not list the points that it left out.
    left_out_ = cloud_.beyond(exact_reference_, epsilon_, {});
    if (!holds(reference_)) {
      if (rounding > 0) {
        throw Error(
            "32-bit coordinates cannot keep the mesh within its bounds; write .ply, .obj or .off");
      }
      throw std::logic_error("the reference is not within the bounds of itself");
    }
    return std::move(result_);
  }

 private:
  TriangleMesh decimated(double reduction) {
    DecimationSettings settings = settings_.decimation;
    settings.epsilon = epsilon_ * (1 - reduction);
    settings.epsilon_back = epsilon_back_ * (1 - reduction);
    if (settings_.early) {
      settings.early = [this](DecimatedMesh early) { show(std::move(early)); };
    }
    DecimatedMesh decimated = decimate_(settings);
    result_.interrupted = result_.interrupted || decimated.interrupted;
    left_out_.insert(left_out_.end(), decimated.left_out.begin(), decimated.left_out.end());
    return std::move(decimated.mesh);
  }

  void show(DecimatedMesh early) {
    std::swap(left_out_, early.left_out);
    if (holds(early.mesh)) settings_.early(result_);
    std::swap(left_out_, early.left_out);
  }

  // Checks the mesh as it is stored.
  bool holds(const TriangleMesh& mesh) {
    result_.mesh = as_stored(mesh, settings_.storage);
    const MeshView view = result_.mesh.view();
    const ExactMesh exact(view);
    const std::size_t threads = settings_.decimation.threads;
    std::vector<std::function<void()>> proofs = {
        [&] { result_.validity = check_mesh(view); },
        [&] { result_.points = cloud_.certify(exact, beyond_for_good(exact)); }};
    if (settings_.decimation.two_sided) {
      proofs.emplace_back([&] {
        result_.mesh_to_reference = decided_distance(view, exact_reference_, epsilon_back_);
      });
      proofs.emplace_back([&] {
        result_.reference_to_mesh = decided_distance(reference_.view(), exact, epsilon_);
      });
    }
    in_pieces(threads, proofs.size(), 1,
              [&proofs](std::size_t, std::size_t proof, std::size_t) { proofs[proof](); });
    return as_valid() && result_.points.within(epsilon_) &&
           (!settings_.decimation.two_sided || (result_.mesh_to_reference->within(epsilon_back_) &&
                                                result_.reference_to_mesh->within(epsilon_)));
  }

  // As many pairs of triangles may meet as in the reference.
  bool as_valid() const {
    MeshValidity validity = result_.validity;
    if (validity.self_intersections <= own_validity_.self_intersections) {
      validity.self_intersections = 0;
    }
    return validity.valid();
  }

  // The points left out at the start that are still too far by exact distances.
  std::vector<std::uint32_t> beyond_for_good(const ExactMesh& mesh) {
    sort_once(left_out_);
    if (left_out_.empty()) return {};
    return cloud_.beyond(mesh, epsilon_, left_out_);
  }

  const TriangleMesh& reference_;
  const ExactMesh exact_reference_;
  const MeshValidity own_validity_;
  const ProvenCloud& cloud_;
  const CertifiedDecimationSettings& settings_;
  const Decimate& decimate_;
  double epsilon_, epsilon_back_;
  std::vector<std::uint32_t> left_out_;
  CertifiedDecimation result_;
};

}  // namespace

CertifiedError ProvenPoints::certify(const ExactMesh& mesh,
                                     std::span<const std::uint32_t> excluded) const {
  return emax::certify(points_, mesh, excluded);
}

std::vector<std::uint32_t> ProvenPoints::beyond(
    const ExactMesh& mesh, double epsilon,
    std::optional<std::span<const std::uint32_t>> points) const {
  std::vector<std::uint32_t> beyond;
  const auto look_at = [&](std::uint32_t p) {
    if (mesh.distance(points_[p]).upper > epsilon) beyond.push_back(p);
  };
  if (points) {
    std::ranges::for_each(*points, look_at);
  } else {
    for (std::uint32_t p = 0; p < points_.size(); ++p) look_at(p);
  }
  return beyond;
}

CertifiedDecimation decimate_certified(const TriangleMesh& reference, std::span<const Point> cloud,
                                       const CertifiedDecimationSettings& settings) {
  return decimate_certified(reference, ProvenPoints(cloud), settings,
                            [&](const DecimationSettings& bounded) {
                              return BoundedDecimator(reference, cloud).run(bounded);
                            });
}

CertifiedDecimation decimate_certified(const TriangleMesh& reference, const ProvenCloud& cloud,
                                       const CertifiedDecimationSettings& settings,
                                       const Decimate& decimate) {
  return Attempts(reference, cloud, settings, decimate).run();
}

}  // namespace emax
