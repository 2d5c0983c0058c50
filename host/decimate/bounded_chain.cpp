#include "host/decimate/bounded_chain.h"

#include <algorithm>
#include <cmath>

#include "host/decimate/chain_parameters.h"
#include "host/decimate/drop_components.h"
#include "host/decimate/far_points.h"
#include "host/decimate/manifold_part.h"
#include "sw_model/error.h"

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

}  // namespace

BoundedStage::BoundedStage(std::span<const Point> points, DecimationBound bound)
    : bound_(std::move(bound)), kept_(points_without(points, bound_.outliers)) {
  if (!two_sided()) return;
  back_.emplace(bound_.reference, kInside * bound_.epsilon_back);
  exact_reference_.emplace(bound_.reference.view());
}

TriangleMesh BoundedStage::without_needless(TriangleMesh surface) const {
  if (!(bound_.epsilon > 0)) return surface;
  return drop_needless_components(std::move(surface), kept_, bound_.epsilon / 2);
}

TriangleMesh BoundedStage::start(const TriangleMesh& surface) const {
  if (!(bound_.epsilon > 0)) throw Error("the bounded decimator was given no bound");
  const double far = bound_.epsilon / 2;
  if (!two_sided()) return reference_surface(surface, kept_, far).mesh;
  TriangleMesh part = manifold_part(surface).mesh;
  const std::size_t strayed = std::erase_if(part.triangles, [&](const Triangle& t) {
    const std::array<Point, 3> corners = {part.vertices[t[0]], part.vertices[t[1]],
                                          part.vertices[t[2]]};
    const std::uint32_t near = back_->sight(corners[0]).triangle;
    return near == kNoIndex || !back_->holds(corners, near);
  });
  if (part.triangles.empty()) throw Error("all of the surface strays from the reference");
  if (strayed > 0) part = manifold_part(part).mesh;
  FarPoints inserted = insert_far_points(part, kept_, far, nullptr, &*back_);
  return cover_far_points(std::move(inserted.mesh), kept_, inserted.left_out, *back_,
                          kInside * bound_.epsilon);
}

TriangleMesh BoundedStage::decimate(const TriangleMesh& start,
                                    const ParameterValues& values) const {
  DecimationSettings settings;
  settings.epsilon = bound_.epsilon;
  settings.epsilon_back = bound_.epsilon_back;
  settings.two_sided = two_sided();
  static_assert(static_cast<DecimationSettings::Effort>(kDeepEffort) ==
                DecimationSettings::Effort::kDeep);
  settings.effort = static_cast<DecimationSettings::Effort>(values.at(kBoundedEffort));
  settings.normal_cosine = values.at("bounded.normal_cosine");
  settings.flatness = values.at("bounded.flatness");
  const TriangleMesh& reference = two_sided() ? bound_.reference : start;
  TriangleMesh mesh = BoundedDecimator(reference, kept_).run(start, settings).mesh;
  return drop_needless_components(std::move(mesh), kept_, kInside * bound_.epsilon);
}

double BoundedStage::back_distance(const TriangleMesh& mesh) const {
  if (!two_sided()) return 0;
  return bounded_distance(mesh.view(), *exact_reference_, bound_.epsilon_back);
}

double BoundedStage::reference_distance(const TriangleMesh& mesh) const {
  if (!two_sided()) return 0;
  return bounded_distance(bound_.reference.view(), ExactMesh(mesh.view()), bound_.epsilon);
}

}  // namespace emax
