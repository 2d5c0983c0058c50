#include "host/decimate/bounded_decimation.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "host/decimate/decimation_passes.h"
#include "host/decimate/far_points.h"
#include "host/decimate/manifold_part.h"
#include "host/geometry/bounds.h"
#include "sw_model/error.h"

namespace emax {
namespace {

using Effort = DecimationSettings::Effort;
using Fault = DecimationSettings::Fault;

// The local tests round a few units in the last place of the coordinates.
constexpr double kRoundings = 0x1p-46;
constexpr double kMargin = 1e-7;
constexpr double kBelongs = 0.1;  // of the mesh's width

// Of the time that is thought to be left, what the passes take.
constexpr double kFirstPass = 0.75, kOtherPass = 0.3;

double greatest_coordinate(const TriangleMesh& mesh, std::span<const Point> cloud) {
  double greatest = 0;
  for (const Point& p : mesh.vertices) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  for (const Point& p : cloud) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  return greatest;
}

double limit_of(double epsilon, double roundings) {
  if (!(epsilon > 0) || !std::isfinite(epsilon)) {
    throw Error("the maximum error of a decimation has to be positive and finite");
  }
  if (epsilon < 1e3 * roundings) {
    throw Error(
        "the maximum error is lost in the roundings of the coordinates; move the data "
        "closer to the origin or allow more");
  }
  return epsilon * (1 - kMargin) - roundings;
}

void require_belonging(const TriangleMesh& mesh, std::span<const Point> cloud) {
  const double width = bounds_of(mesh.vertices).width();
  const DecimationState state(mesh, cloud, nullptr, kBelongs * kBelongs * width * width, {});
  std::size_t away = 0;
  for (std::uint32_t p = 0; p < cloud.size(); ++p) {
    if (state.assigned().owner(p) == kNoIndex) ++away;
  }
  if (2 * away > cloud.size()) {
    throw Error(
        "the cloud does not belong to the mesh: " + std::to_string(away) + " of " +
        std::to_string(cloud.size()) +
        " points are farther from it than a tenth of its width; give the mesh's own cloud, in "
        "its unit");
  }
}

}  // namespace

ReferenceSurface reference_surface(const TriangleMesh& mesh, std::span<const Point> cloud,
                                   double far, const std::function<bool()>& interrupted) {
  if (cloud.empty()) throw Error("there is no point to keep a mesh close to; give a cloud");
  ManifoldPart part = manifold_part(mesh);
  if (part.mesh.triangles.empty()) {
    throw Error("the mesh has no triangle of any area that could be decimated; reconstruct first");
  }
  require_belonging(part.mesh, cloud);
  FarPoints inserted = insert_far_points(part.mesh, cloud, far, interrupted);
  return {std::move(inserted.mesh), part.dropped, inserted.inserted, std::move(inserted.left_out)};
}

DecimatedMesh BoundedDecimator::run(const TriangleMesh& start,
                                    const DecimationSettings& settings) const {
  if (start.triangles.empty()) throw Error("the mesh has no triangles to decimate");
  const double roundings = kRoundings * greatest_coordinate(start, cloud_);
  const double limit = limit_of(settings.epsilon, roundings);
  std::unique_ptr<BackBound> back;
  if (settings.two_sided) {
    const bool own = settings.epsilon_back > 0;
    const double epsilon_back = own ? settings.epsilon_back : settings.epsilon;
    back = std::make_unique<BackBound>(reference_, limit_of(epsilon_back, roundings));
  }
  DecimationState::Guards guards;
  guards.normal_cosine = settings.normal_cosine;
  guards.flatness = settings.flatness;
  guards.skip_points = settings.fault == Fault::kSkipsPoints;
  guards.skip_back_bound = settings.fault == Fault::kSkipsBackBound;
  guards.skip_intersections = settings.fault == Fault::kSkipsIntersections;
  DecimationState state(start, cloud_, back.get(), limit * limit, guards);

  DecimatedMesh result;
  for (std::uint32_t p = 0; p < cloud_.size(); ++p) {
    if (state.assigned().owner(p) == kNoIndex) result.left_out.push_back(p);
  }
  double begun = 0, weight = settings.effort == Effort::kCollapse ? 1 : kFirstPass;
  DecimationPasses passes(state, [&](double done) {
    if (settings.advanced) settings.advanced(begun + weight * done, state.mesh().triangles());
    return settings.interrupted && settings.interrupted();
  });
  const auto tell = [&](const char* pass, std::size_t edits) {
    if (settings.progress) settings.progress(pass, edits, state.mesh().triangles());
    begun += weight;
    weight = (1 - begun) * kOtherPass;
    return edits;
  };
  const auto relax = [&] {
    tell("turns", passes.flip(4));
    tell("moves", passes.relocate(4));
    return tell("collapses", passes.collapse());
  };
  tell("collapses", passes.collapse());
  if (settings.effort != Effort::kCollapse) {
    state.reassign();
    tell("moves", passes.relocate(4));
    relax();
    for (bool gained = true; gained && !passes.stopped();) {
      state.reassign();
      const std::size_t mended = tell("mended collapses", passes.collapse_and_mend());
      const std::size_t more = relax();
      gained = mended + more > 0 && settings.effort == Effort::kDeep;
    }
  }
  result.interrupted = passes.stopped();
  result.mesh = state.mesh().compact();
  return result;
}

}  // namespace emax
