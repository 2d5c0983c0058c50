#include "host/decimate/edit_proposer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace emax {
namespace {

constexpr double kHopeless = 4;    // squared distance / limit^2 from which finer steps do not help
constexpr double kMendable = 2.5;  // squared distance / limit^2 up to which mending is tried
constexpr double kNothing = 1e-8;  // an energy too small to be worth a move
constexpr double kNothingOfHighPowers = 1e-30;

// The least share of its energy that a move or flip gains. Where it is of a high power, the
// distances gain that share over the power.
double least_gain(int power) { return 1e-3 * (power > 4 ? power : 1); }

constexpr double kInPlace = 1e-6;  // of the limit
// To a place that may be out of reach.
constexpr std::array kPartsOfWay = {1.0, 0.5, 0.25, 0.125};

// Toward the true edges.
constexpr std::array kPartsToEdges = {1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125};
constexpr int kStepsToEdges = 5;
constexpr double kLeastNearer = 1e-3;  // the share of the distances that a move gains

// Whether the vertex lies on a curved shape that a triangle beside it follows.
bool lies_on_curved(const DecimationState& state, std::uint32_t vertex) {
  const double apart = kInPlace * std::sqrt(state.squared_limit());
  bool lies = false;
  state.mesh().for_each_slot_at(vertex, [&](std::uint32_t slot) {
    if (lies || state.shape_of(slot) == kNoIndex) return;
    const Shape& shape = state.shape(state.shape_of(slot));
    const bool curved = !std::holds_alternative<Plane>(shape);
    lies = curved && distance(shape, state.mesh().position(vertex)) <= apart;
  });
  return lies;
}

// What lies on a curved shape does not leave it when the edge collapses, unless it could lie
// nowhere. Facets are longer with their corners beside the shape, so hardly a vertex would stay.
bool stays_curved(const DecimationState& state, const LocalSearch& search, std::uint32_t a,
                  std::uint32_t b) {
  return search.place() && (lies_on_curved(state, a) || lies_on_curved(state, b));
}

}  // namespace

bool EditProposer::keeps_features(std::uint32_t a, std::uint32_t b, const Point& at) const {
  return options_.features.stays_near(a, b, at, state_.mesh().positions(), state_.squared_limit());
}

bool EditProposer::judge(std::uint32_t a, std::uint32_t b, int power, Collapse& collapse,
                         bool in_place) {
  const FeatureEdges::Collapse feature = permitted(a, b);
  if (feature == FeatureEdges::Collapse::kForbidden) return false;
  if (!search_.prepare_collapse(a, b)) return false;
  const Point pa = state_.mesh().position(a), pb = state_.mesh().position(b);
  const bool hoppe = options_.representation > 0;
  if (hoppe) power = 2;
  const double before = search_.energy_before(power) + options_.representation;
  Fit fit;
  if (feature == FeatureEdges::Collapse::kAlong) {
    if (!judge_along_feature(a, b, power, fit)) return false;
  } else if (feature != FeatureEdges::Collapse::kAnywhere) {
    const Point& kept = feature == FeatureEdges::Collapse::kAtFirst ? pa : pb;
    if (!search_.evaluate(kept, power, fit)) return false;
    if (fit.worst > 1 && !search_.finish(fit, true, edit_)) return false;
  } else if (hoppe) {
    if (!judge_for_hoppe(pa, pb, fit)) return false;
  } else if (stays_curved(state_, search_, a, b) ? !judge_in_place(pa, pb, power, fit)
                                                 : !judge_free(pa, pb, power, in_place, fit)) {
    return false;
  }
  if (hoppe && !(fit.energy < before)) return false;
  if (!keeps_features(a, b, fit.position)) return false;
  collapse.a = a;
  collapse.b = b;
  collapse.cost = fit.energy - before;
  collapse.fit = std::move(fit);
  return true;
}

// The optimum of the planes' quadrics is where the sides of the feature meet.
bool EditProposer::judge_along_feature(std::uint32_t a, std::uint32_t b, int power, Fit& fit) {
  for (const Point& at :
       {search_.quadric_optimum(), state_.mesh().position(a), state_.mesh().position(b)}) {
    if (keeps_features(a, b, at) && search_.evaluate(at, power, fit) && fit.worst <= 1) return true;
  }
  return false;
}

bool EditProposer::judge_for_hoppe(const Point& pa, const Point& pb, Fit& fit) {
  LocalSearch::Options options;
  options.power = 2;
  bool any = false;
  for (const Point& start : {Point(0.5 * (pa + pb)), pa, pb}) {
    Fit other;
    if (!search_.fit(start, options, other)) continue;
    if (!any || other.energy < fit.energy) fit = other;
    any = true;
  }
  return any && fit.worst <= 1;
}

// Finds the position where the energy of the prepared collapse is least. Returns whether it may be
// within the limit.
bool EditProposer::judge_free(const Point& pa, const Point& pb, int power, bool in_place,
                              Fit& fit) {
  if (in_place && search_.place() && judge_in_place(pa, pb, power, fit)) return true;
  LocalSearch::Options options;
  options.power = power;
  if (search_.fine()) options.steps = 0;
  bool any = search_.fit(search_.quadric_optimum(), options, fit);
  for (const Point& start : {Point(0.5 * (pa + pb)), pa, pb}) {
    if (any) break;
    any = search_.fit(start, options, fit);
  }
  if (!any || fit.worst > kHopeless) return false;
  if (fit.worst <= state_.permitted()) return true;
  if (state_.loosened()) return false;
  options.power = 8;
  options.steps = 8;
  Fit finer;
  if (search_.fit(fit.position, options, finer) && finer.worst < fit.worst) {
    search_.evaluate(finer.position, 4, fit);
  }
  return fit.worst <= 1 || search_.finish(fit, true, edit_);
}

// The same in the place of the planes that the triangles follow.
bool EditProposer::judge_in_place(const Point& pa, const Point& pb, int power, Fit& fit) {
  LocalSearch::Options options;
  options.power = power;
  options.in_place = true;
  if (search_.fine()) options.steps = 0;
  for (const Point& start : {search_.quadric_optimum(), Point(0.5 * (pa + pb)), pa, pb}) {
    if (search_.fit(start, options, fit)) return fit.worst <= state_.permitted();
  }
  return false;
}

bool EditProposer::is_in_place(const Point& at) const {
  const double apart = kInPlace * kInPlace * state_.squared_limit();
  return (at - search_.place()->project(at)).squaredNorm() <= apart;
}

// By the features and by what is held.
FeatureEdges::Collapse EditProposer::permitted(std::uint32_t a, std::uint32_t b) const {
  const bool held = options_.holds(a) || options_.holds(b);
  return held ? FeatureEdges::Collapse::kForbidden : options_.features.permitted(a, b);
}

bool EditProposer::judge_beyond(std::uint32_t a, std::uint32_t b, Collapse& collapse) {
  if (permitted(a, b) != FeatureEdges::Collapse::kAnywhere) return false;
  if (!search_.prepare_collapse(a, b)) return false;
  LocalSearch::Options options;
  options.power = 8;
  options.steps = 8;
  bool any = false;
  const Point middle = 0.5 * (state_.mesh().position(a) + state_.mesh().position(b));
  const bool leaves = !stays_curved(state_, search_, a, b);
  for (const Point& start : {search_.quadric_optimum(), middle}) {
    Fit fit;
    options.in_place = search_.place().has_value();
    bool found = search_.fit(start, options, fit);
    if (options.in_place && leaves && !(found && fit.worst <= kMendable)) {
      options.in_place = false;
      found = search_.fit(start, options, fit);
    }
    if (!found) continue;
    if (!any || fit.worst < collapse.fit.worst) collapse.fit = fit;
    any = true;
  }
  collapse.a = a;
  collapse.b = b;
  collapse.cost = collapse.fit.worst;
  return any && collapse.cost <= kMendable;
}

bool EditProposer::rate(std::uint32_t a, std::uint32_t b, int power, Collapse& collapse) {
  Fit fit;
  if (permitted(a, b) == FeatureEdges::Collapse::kForbidden) return false;
  if (!search_.prepare_collapse(a, b)) return false;
  const Point optimum = search_.quadric_optimum();
  const Point at = search_.place() ? search_.place()->project(optimum) : optimum;
  if (!search_.evaluate(at, power, fit)) return false;
  collapse.a = a;
  collapse.b = b;
  collapse.cost = fit.energy - search_.energy_before(power);
  return true;
}

bool EditProposer::plain_collapse(std::uint32_t a, std::uint32_t b, double most, bool in_place) {
  if (permitted(a, b) != FeatureEdges::Collapse::kAnywhere) return false;
  if (!search_.prepare_collapse(a, b)) return false;
  LocalSearch::Options options;
  options.steps = 0;
  options.in_place = search_.place() && (in_place || stays_curved(state_, search_, a, b));
  Fit fit;
  if (!search_.fit(search_.quadric_optimum(), options, fit) || fit.worst > most) return false;
  return keeps_features(a, b, fit.position) && search_.finish(fit, true, edit_);
}

bool EditProposer::relocation(std::uint32_t vertex, int power, bool limit) {
  if (options_.features.fixed(vertex) || options_.holds(vertex)) return false;
  if (!search_.prepare_relocation(vertex)) return false;
  const double before = search_.energy_before(power);
  if (before < (power > 4 ? kNothingOfHighPowers : kNothing)) return false;
  Fit fit;
  LocalSearch::Options options;
  options.power = power;
  const Point& at = state_.mesh().position(vertex);
  options.in_place = search_.place() && is_in_place(at);
  if (!search_.fit(at, options, fit)) return false;
  return fit.energy < before * (1 - least_gain(power)) && search_.finish(fit, limit, edit_);
}

bool EditProposer::into_place(std::uint32_t vertex) {
  if (options_.features.fixed(vertex) || options_.holds(vertex)) return false;
  if (!search_.prepare_relocation(vertex) || !search_.place()) return false;
  const Point at = state_.mesh().position(vertex);
  if (is_in_place(at)) return false;
  const Point place = search_.place()->project(at);
  for (const double part : kPartsOfWay) {
    Fit fit;
    if (search_.evaluate(at + part * (place - at), kPower, fit) && fit.worst <= 1 &&
        search_.finish(fit, true, edit_)) {
      return true;
    }
  }
  return false;
}

bool EditProposer::toward_edges(std::uint32_t vertex, const TrueEdges& edges) {
  if (options_.features.fixed(vertex) || options_.holds(vertex)) return false;
  const Point at = state_.mesh().position(vertex);
  const double before = edges.distance(state_.mesh(), vertex, at);
  if (!(before > 0) || !search_.prepare_relocation(vertex)) return false;
  const bool stays = search_.place() && is_in_place(at);
  Point to = at;
  for (int i = 0; i < kStepsToEdges; ++i) {
    const Eigen::Matrix3d along =
        stays ? search_.place()->along(to) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    to = edges.step(state_.mesh(), vertex, to, along);
    if (stays) to = search_.place()->project(to);
  }
  for (const double part : kPartsToEdges) {
    Point there = at + part * (to - at);
    if (stays) there = search_.place()->project(there);
    if (!(edges.distance(state_.mesh(), vertex, there) < (1 - kLeastNearer) * before)) continue;
    Fit fit;
    if (search_.evaluate(there, kPower, fit) && fit.worst <= 1 &&
        search_.finish(fit, true, edit_)) {
      return true;
    }
  }
  return false;
}

bool EditProposer::may_split(std::uint32_t a, std::uint32_t b) const {
  return !options_.features.on(a, b) && !(options_.fixes(a) && options_.fixes(b));
}

// What is around fixed edges is free, unlike what is around a held vertex.
bool EditProposer::may_flip(std::uint32_t a, std::uint32_t b) const {
  const auto [first, second] = state_.mesh().slots_at_edge(a, b);
  if (state_.shape_of(first) != state_.shape_of(second)) return false;
  return may_split(a, b) &&
         std::ranges::none_of(state_.mesh().slots_at_edge(a, b), [this](std::uint32_t slot) {
           return slot != kNoIndex &&
                  std::ranges::any_of(state_.mesh().triangle(slot),
                                      [this](std::uint32_t v) { return options_.stays(v); });
         });
}

bool EditProposer::may_split(const Triangle& triangle) const {
  return !std::ranges::all_of(triangle, [this](std::uint32_t v) { return options_.fixes(v); });
}

bool EditProposer::flip(std::uint32_t a, std::uint32_t b, int power, bool limit) {
  if (!may_flip(a, b) || !search_.prepare_flip(a, b)) return false;
  const double before = search_.energy_before(power);
  Fit fit;
  return search_.evaluate(Point::Zero(), power, fit, before * (1 - least_gain(power))) &&
         search_.finish(fit, limit, edit_);
}

}  // namespace emax
