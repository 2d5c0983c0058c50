#include "host/decimate/decimation_sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/bounds.h"

namespace emax {
namespace {

constexpr double kFinest = 1.0 / 32;  // of the width divided by the root of the number of vertices
constexpr double kStep = std::numbers::sqrt2;  // from a mesh's bounds to the next one's
constexpr double kShare = 0.72;  // a cut starts from a mesh with at most this share of its bounds
constexpr double kReach = 0.1;   // of the width
constexpr double kLeastFinest = 1e-12;  // of the greatest coordinate

}  // namespace

DecimationSequence::DecimationSequence(const TriangleMesh& reference, std::span<const Point> cloud)
    : decimator_(reference, cloud), reference_(reference) {
  if (reference.vertices.empty()) return;
  const Bounds box = bounds_of(reference.vertices);
  const double greatest =
      std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
  const double spacing = box.width() / std::sqrt(static_cast<double>(reference.vertices.size()));
  finest_ = std::max(kFinest * spacing, kLeastFinest * greatest);
  reach_ = kReach * box.width();
}

DecimatedMesh DecimationSequence::cut(const DecimationSettings& settings) {
  double bound = settings.epsilon;
  if (settings.two_sided && settings.epsilon_back > 0) {
    bound = std::min(bound, settings.epsilon_back);
  }
  const TriangleMesh* start = &reference_;
  // The meshes of the sequence were made without features, so a cut with features must start from
  // the reference. Hoppe's energy keeps vertices where the other objective leaves none.
  const bool direct = settings.feature_angle > 0 || settings.planes ||
                      settings.objective != DecimationSettings::Objective::kFewest;
  std::vector<TriangleMesh>& meshes = meshes_[settings.two_sided ? 1 : 0];
  double below = finest_;
  for (std::size_t level = 0; !direct && below > 0 && below <= kShare * bound; ++level) {
    if (level == meshes.size()) {
      DecimationSettings finer;
      finer.epsilon = below;
      finer.two_sided = settings.two_sided;
      finer.effort = DecimationSettings::Effort::kCollapse;
      finer.leaves_room = true;
      finer.interrupted = settings.interrupted;
      DecimatedMesh made = decimator_.run(*start, finer, reach_);
      if (made.interrupted) return made;
      meshes.push_back(std::move(made.mesh));
    }
    start = &meshes[level];
    below *= kStep;
  }
  return decimator_.run(*start, settings, 0);
}

}  // namespace emax
