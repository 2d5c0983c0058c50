#include "host/decimate/bounded_decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "host/decimate/decimation_passes.h"
#include "host/decimate/far_points.h"
#include "host/decimate/manifold_part.h"
#include "host/decimate/spatial_order.h"
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
constexpr double kSweeps = 0.4, kOtherPass = 0.3;

double greatest_coordinate(std::initializer_list<std::span<const Point>> sets) {
  double greatest = 0;
  for (const std::span<const Point> points : sets) {
    for (const Point& p : points) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  }
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

void require_belonging(const DecimationState& state) {
  const AssignedPoints& assigned = state.assigned();
  std::size_t away = 0;
  for (std::uint32_t p = 0; p < assigned.size(); ++p) {
    if (assigned.owner(p) == kNoIndex) ++away;
  }
  if (2 * away > assigned.size()) {
    throw Error(
        "the cloud does not belong to the mesh: " + std::to_string(away) + " of " +
        std::to_string(assigned.size()) +
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
  const double reach = std::max(far, kBelongs * bounds_of(part.mesh.vertices).width());
  DecimationState state(part.mesh, cloud, nullptr, reach * reach, {}, interrupted);
  if (!state.complete()) return {std::move(part.mesh), part.dropped, 0, {}};
  require_belonging(state);
  FarPoints inserted = insert_far_points(state, far, interrupted);
  return {std::move(inserted.mesh), part.dropped, inserted.inserted, std::move(inserted.left_out)};
}

// What runs share: the cloud along a curve and the trees of the reference.
struct BoundedDecimator::Prepared {
  std::vector<std::uint32_t> order;
  std::vector<Point> cloud;  // in that order
  std::unique_ptr<BackBound> back;
};

const BoundedDecimator::Prepared& BoundedDecimator::prepared(double back_limit) const {
  if (prepared_ == nullptr) {
    prepared_ = std::make_shared<Prepared>();
    prepared_->order = spatial_order(cloud_);
    prepared_->cloud.reserve(cloud_.size());
    for (const std::uint32_t p : prepared_->order) prepared_->cloud.push_back(cloud_[p]);
  }
  if (back_limit > 0) {
    if (prepared_->back == nullptr) {
      prepared_->back = std::make_unique<BackBound>(reference_, back_limit);
    }
    prepared_->back->set_limit(back_limit);
  }
  return *prepared_;
}

DecimatedMesh BoundedDecimator::run(const TriangleMesh& start,
                                    const DecimationSettings& settings) const {
  return run(start, settings, 0);
}

DecimatedMesh BoundedDecimator::run(const TriangleMesh& start, const DecimationSettings& settings,
                                    double reach) const {
  if (start.triangles.empty()) throw Error("the mesh has no triangles to decimate");
  const double roundings =
      kRoundings * greatest_coordinate({start.vertices, reference_.vertices, cloud_});
  const double limit = limit_of(settings.epsilon, roundings);
  double back_limit = 0;
  if (settings.two_sided) {
    const bool own = settings.epsilon_back > 0;
    back_limit = limit_of(own ? settings.epsilon_back : settings.epsilon, roundings);
  }
  const Prepared& known = prepared(back_limit);
  DecimationState::Guards guards;
  guards.normal_cosine = settings.normal_cosine;
  guards.flatness = settings.flatness;
  guards.squared_reach = reach * reach;
  guards.skip_points = settings.fault == Fault::kSkipsPoints;
  guards.skip_back_bound = settings.fault == Fault::kSkipsBackBound;
  guards.skip_intersections = settings.fault == Fault::kSkipsIntersections;
  const TriangleMesh ordered = spatially_ordered(start);
  DecimationState state(ordered, known.cloud, settings.two_sided ? known.back.get() : nullptr,
                        limit * limit, guards, settings.interrupted);

  if (!state.complete()) return {start, {}, true};

  DecimatedMesh result;
  for (std::uint32_t p = 0; p < known.cloud.size(); ++p) {
    if (state.assigned().owner(p) == kNoIndex) result.left_out.push_back(known.order[p]);
  }
  std::ranges::sort(result.left_out);
  DecimationPasses::Options options;
  options.length_weight = settings.length_weight;
  if (settings.feature_angle > 0) options.features = FeatureEdges(ordered, settings.feature_angle);
  const bool hoppe = settings.objective == DecimationSettings::Objective::kHoppe;
  if (hoppe) {
    const double width = bounds_of(reference_.vertices).width();
    options.spring = settings.hoppe.spring;
    options.representation = settings.hoppe.representation * width * width / (limit * limit);
  }
  const bool single = hoppe || settings.effort == Effort::kSweep;
  double begun = 0, weight = single ? 1 : kSweeps;
  DecimationPasses passes(state, std::move(options), [&](double done) {
    if (settings.advanced) settings.advanced(begun + weight * done, state.mesh().triangles());
    return settings.interrupted && settings.interrupted();
  });
  const auto tell = [&](const char* pass, std::size_t edits) {
    if (settings.progress) settings.progress(pass, edits, state.mesh().triangles());
    begun += weight;
    weight = (1 - begun) * (settings.effort == Effort::kCollapse ? 1 : kOtherPass);
    return edits;
  };
  const auto relax = [&] {
    tell("flips", passes.flip(4));
    tell("relocations", passes.relocate(4));
    return tell("collapses", passes.collapse());
  };
  if (hoppe) {
    tell("descent", passes.descend());
  } else {
    tell("sweeps", passes.sweep());
    if (settings.effort != Effort::kSweep) tell("collapses", passes.collapse());
  }
  if (!single && settings.effort != Effort::kCollapse && !passes.stopped()) {
    state.reassign();
    tell("relocations", passes.relocate(4));
    relax();
    const bool deep = settings.effort == Effort::kDeep;
    // Once, or until nothing is gained; whether anything was.
    const auto mend = [&] {
      bool any = false;
      for (bool again = true; again && !passes.stopped();) {
        state.reassign();
        const std::size_t mended = tell("mended collapses", passes.collapse_and_mend());
        const bool gained = mended + relax() > 0;
        any = any || gained;
        again = gained && deep;
      }
      return any;
    };
    mend();
    // Another measure of how well points are met moves the mesh out of where the search has ended.
    constexpr std::array<int, 3> kOtherPowers = {2, 8, 6};
    const std::size_t tries = deep ? kOtherPowers.size() : 1;
    for (std::size_t vain = 0; vain < tries && !passes.stopped();) {
      const int power = kOtherPowers[vain++];
      tell("flips", passes.flip(power));
      tell("relocations", passes.relocate(power));
      tell("relocations", passes.relocate(4));
      if (mend() && deep) vain = 0;
    }
  }
  result.interrupted = passes.stopped();
  result.mesh = state.mesh().compact();
  return result;
}

}  // namespace emax
