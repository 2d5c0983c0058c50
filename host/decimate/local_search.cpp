#include "host/decimate/local_search.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/sort_once.h"
#include "sw_model/model/triangle_frame.h"

namespace emax {
namespace {

// Points with less than this share of the greatest squared distance do not count in a step.
constexpr double kNegligibleShare = 0.01;

// Shares of the trace of the normal equations. A vertex moves along the surface by steps whose
// squared slopes are about the limit times the curvature, which more damping would prevent.
constexpr double kFixedDamping = 1e-3, kLeastDamping = 1e-5;
constexpr double kMoreDamping = 30, kLessDamping = 0.2;

// Squared distance / limit^2 of edges and of triangles' middles under loosened limits.
constexpr double kLoosenedEdge = 2;
// Guides for each triangle of an edit that are enough for the steps of Newton.
constexpr std::size_t kGuidesOfNewton = 20;
// Of the limit: so far the shapes at a vertex may pass from the place that they have in common.
constexpr double kPlanesApart = 0.1;

Triangle rotated_to(const Triangle& t, std::uint32_t vertex) {
  if (t[1] == vertex) return {t[1], t[2], t[0]};
  if (t[2] == vertex) return {t[2], t[0], t[1]};
  return t;
}

}  // namespace

void LocalSearch::use(Steps steps) {
  steps_ = steps;
  samples_.enable(steps == Steps::kNewton && spring_ == 0);
}

void LocalSearch::begin(std::uint32_t vertex, std::uint32_t other) {
  vertex_ = vertex;
  other_ = other;
  sight_ = state_.sight(vertex);
  removed_.clear();
  added_.clear();
  normals_.clear();
  place_.reset();
}

void LocalSearch::replace(std::uint32_t slot, std::uint32_t corner) {
  Triangle t = rotated_to(state_.mesh().triangle(slot), corner);
  t[0] = vertex_;
  removed_.push_back(slot);
  added_.push_back(t);
  normals_.push_back(state_.area_normal(slot).normalized());
}

// What a collapse removes without replacing it has no say.
void LocalSearch::take_place() {
  if (!state_.follows_shapes() || vertex_ == kNoIndex || EMAX_FAULT(kForgetsPlanes)) return;
  std::vector<std::uint32_t> numbers;
  const std::size_t replaced = other_ == kNoIndex ? removed_.size() : added_.size();
  for (std::size_t i = 0; i < replaced; ++i) numbers.push_back(state_.shape_of(removed_[i]));
  sort_once(numbers);
  if (!numbers.empty() && numbers.back() == kNoIndex) numbers.pop_back();
  if (numbers.empty()) return;
  std::vector<Shape> shapes;
  for (const std::uint32_t number : numbers) shapes.push_back(state_.shape(number));
  place_ = place_on(shapes, state_.mesh().position(vertex_),
                    kPlanesApart * std::sqrt(state_.squared_limit()));
}

void LocalSearch::take_points() {
  take_place();
  ids_.clear();
  for (const std::uint32_t slot : removed_) {
    state_.assigned().for_each_guide(slot, [&](std::uint32_t p) { ids_.push_back(p); });
  }
  choose_guiding_points();
  const bool near_limit = !samples_.none() || !fine();
  watch_back_ = state_.back() != nullptr && vertex_ != kNoIndex && spring_ == 0 && near_limit;
  samples_.take(removed_, added_, vertex_, other_);
}

// Of many guides an even share is enough for Newton's steps; finish() tests all points.
void LocalSearch::choose_guiding_points() {
  const std::size_t enough = kGuidesOfNewton * added_.size();
  const std::size_t stride =
      steps_ == Steps::kNewton && ids_.size() > enough ? ids_.size() / enough : 1;
  guiding_ids_.clear();
  guiding_.clear();
  for (std::size_t i = stride / 2; i < ids_.size(); i += stride) {
    guiding_ids_.push_back(ids_[i]);
    guiding_.push_back(state_.point(ids_[i]));
  }
}

bool LocalSearch::prepare_collapse(std::uint32_t a, std::uint32_t b) {
  const EditableMesh& mesh = state_.mesh();
  if (!mesh.collapsible(a, b)) return false;
  begin(a, b);
  const auto gone = mesh.slots_at_edge(a, b);
  for (const std::uint32_t v : {a, b}) {
    mesh.for_each_slot_at(v, [&](std::uint32_t slot) {
      if (slot != gone[0] && slot != gone[1]) replace(slot, v);
    });
  }
  for (const std::uint32_t slot : gone) {
    if (slot != kNoIndex) removed_.push_back(slot);
  }
  take_points();
  take_edges();
  return true;
}

bool LocalSearch::prepare_relocation(std::uint32_t vertex) {
  begin(vertex, kNoIndex);
  state_.mesh().for_each_slot_at(vertex, [&](std::uint32_t slot) { replace(slot, vertex); });
  take_points();
  take_edges();
  return !removed_.empty();
}

bool LocalSearch::prepare_flip(std::uint32_t a, std::uint32_t b) {
  const EditableMesh& mesh = state_.mesh();
  const auto [first, second] = mesh.slots_at_edge(a, b);
  if (second == kNoIndex) return false;
  const Triangle s = rotated_to(mesh.triangle(first), a);
  const Triangle t = rotated_to(mesh.triangle(second), a);
  // One of the two triangles runs from a to b.
  const Triangle& from = s[1] == b ? s : t;
  const std::uint32_t c = opposite(from, a, b);
  const std::uint32_t d = opposite(s[1] == b ? t : s, a, b);
  if (c == d || mesh.slots_at_edge(c, d)[0] != kNoIndex) return false;
  vertex_ = other_ = kNoIndex;
  removed_.assign({first, second});
  added_.assign({{a, d, c}, {d, b, c}});
  // Either new triangle replaces a part of both old ones, so it is compared with the mean of their
  // normals.
  normals_.assign(2,
                  (state_.area_normal(first).normalized() + state_.area_normal(second).normalized())
                      .normalized());
  take_points();
  ring_ = {c, d};
  lengths_before_ = (mesh.position(a) - mesh.position(b)).squaredNorm();
  return true;
}

bool LocalSearch::prepare_split(std::uint32_t a, std::uint32_t b, std::uint32_t middle) {
  const EditableMesh& mesh = state_.mesh();
  begin(middle, kNoIndex);
  for (const std::uint32_t slot : mesh.slots_at_edge(a, b)) {
    if (slot == kNoIndex) continue;
    removed_.push_back(slot);
    for (const std::uint32_t end : {a, b}) {
      Triangle t = mesh.triangle(slot);
      std::ranges::replace(t, end, middle);
      added_.push_back(rotated_to(t, middle));
      normals_.push_back(state_.area_normal(slot).normalized());
    }
  }
  take_points();
  take_edges();
  return !removed_.empty();
}

bool LocalSearch::prepare_split(std::uint32_t slot, std::uint32_t middle) {
  begin(middle, kNoIndex);
  removed_.push_back(slot);
  for (const std::uint32_t corner : state_.mesh().triangle(slot)) {
    Triangle t = state_.mesh().triangle(slot);
    std::ranges::replace(t, corner, middle);
    added_.push_back(rotated_to(t, middle));
    normals_.push_back(state_.area_normal(slot).normalized());
  }
  take_points();
  take_edges();
  return true;
}

void LocalSearch::take_edges() {
  if (spring_ == 0) return;
  const EditableMesh& mesh = state_.mesh();
  lengths_before_ = 0;
  for (const std::uint32_t v : {other_, vertex_}) {
    if (v == kNoIndex) continue;
    mesh.neighbours(v, v == vertex_ ? ring_ : other_ring_);
    for (const std::uint32_t n : v == vertex_ ? ring_ : other_ring_) {
      // The edge that collapses counts once.
      if (v == vertex_ && n == other_) continue;
      lengths_before_ += (mesh.position(n) - mesh.position(v)).squaredNorm();
    }
  }
  if (other_ == kNoIndex) return;
  ring_.insert(ring_.end(), other_ring_.begin(), other_ring_.end());
  sort_once(ring_);
  std::erase_if(ring_, [&](std::uint32_t v) { return v == vertex_ || v == other_; });
}

double LocalSearch::spring_after(const Point& position) const {
  const EditableMesh& mesh = state_.mesh();
  double lengths = 0;
  if (vertex_ == kNoIndex) {
    lengths = (mesh.position(ring_[0]) - mesh.position(ring_[1])).squaredNorm();
  } else {
    for (const std::uint32_t v : ring_) lengths += (mesh.position(v) - position).squaredNorm();
  }
  return spring_ * lengths / state_.squared_limit();
}

double LocalSearch::energy_before(int power) const {
  double energy = spring_ * lengths_before_ / state_.squared_limit();
  for (const std::uint32_t p : guiding_ids_) {
    energy += power_of(state_.assigned().squared_distance(p) / state_.squared_limit(), power);
  }
  if (watch_back_) {
    for (const std::uint32_t v : {vertex_, other_}) {
      const bool present = v != kNoIndex && state_.mesh().used(v);
      if (present) energy += power_of(state_.sight(v).share, power);
    }
  }
  return energy + samples_.energy_before(power);
}

Point LocalSearch::quadric_optimum() const {
  const EditableMesh& mesh = state_.mesh();
  const Point& a = mesh.position(vertex_);
  Point start = other_ == kNoIndex ? a : Point(0.5 * (a + mesh.position(other_)));
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Point right = Point::Zero();
  const auto plane = [&](const Point& normal, const Point& at, double weight) {
    matrix += weight * normal * normal.transpose();
    right += weight * normal.dot(at - start) * normal;
  };
  for (const std::uint32_t slot : removed_) {
    const Triangle& t = mesh.triangle(slot);
    const Point& normal = state_.area_normal(slot);
    plane(normal, mesh.position(t[0]), 1);
    if (mesh.closed()) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      const bool at_vertex = from == vertex_ || to == vertex_ || from == other_ || to == other_;
      if (!at_vertex || mesh.slots_at_edge(from, to)[1] != kNoIndex) continue;
      const Point side = mesh.position(to) - mesh.position(from);
      plane(side.cross(normal).normalized() * side.norm() * side.norm(), mesh.position(from), 1);
    }
  }
  const double trace = matrix.trace();
  if (!(trace > 0)) return start;
  const double weight = 1e-3 * trace;
  matrix.diagonal().array() += weight;
  const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
  // Repeated, so that the point lies on planes that meet in an edge or corner up to the last
  // digits. Where the planes leave a direction free, the start decides.
  Point optimum = Point::Zero();
  for (int i = 0; i < 6; ++i) optimum = solver.solve(right + weight * optimum);
  return start + optimum;
}

bool LocalSearch::shape(const Point& position) {
  const EditableMesh& mesh = state_.mesh();
  frames_.clear();
  for (std::size_t i = 0; i < added_.size(); ++i) {
    const Triangle& t = added_[i];
    const std::array<Point, 3> corners = {vertex_ == kNoIndex ? mesh.position(t[0]) : position,
                                          mesh.position(t[1]), mesh.position(t[2])};
    frames_.push_back(local_frame(corners));
    const LocalFrame& f = frames_.back();
    if (!state_.well_shaped(f)) return false;
    if (!(eigen(f.normal).dot(normals_[i]) >= state_.guards().normal_cosine)) return false;
  }
  return true;
}

// Returns whether the energy is below `most`. The points are measured first, since that costs
// least.
bool LocalSearch::measure_at(const Point& position, int power, double most, Fit& fit) {
  measure(guiding_, frames_);
  fit = {};
  fit.position = position;
  if (spring_ > 0) fit.energy = spring_after(position);
  const double scale = 1 / state_.squared_limit();
  for (std::size_t i = 0; i < guiding_.size(); ++i) {
    const double squared = guiding_.squared[i] * scale;
    fit.energy += power_of(squared, power);
    fit.worst = std::max(fit.worst, squared);
  }
  if (!(fit.energy < most)) return false;
  // The greatest distances between two surfaces of flat pieces are at vertices of one of them.
  if (watch_back_) {
    sight_ = state_.back()->sight_from(position, sight_.triangle);
    fit.energy += power_of(sight_.share, power);
    fit.worst = std::max(fit.worst, sight_.share);
  }
  const EdgeSamples::Energy of_edges = samples_.measure(position, power);
  fit.energy += of_edges.sum;
  fit.worst = std::max(fit.worst, of_edges.worst);
  return fit.energy < most;
}

bool LocalSearch::evaluate(const Point& position, int power, Fit& result, double most) {
  return shape(position) && measure_at(position, power, most, result);
}

// One step of Gauss-Newton on the distances as functions of the vertex. The weights make the sum of
// squares approximate the sum of powers; Newton's step on that sum is the same over power - 1.
bool LocalSearch::step(const Options& options, double damping, Fit& at) const {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Point right = Point::Zero();
  const double scale = 1 / state_.squared_limit();
  const double least = options.power > 2 ? kNegligibleShare * at.worst : 0;
  const bool newton = steps_ == Steps::kNewton;
  const double unit = newton ? 1 / at.worst : 1;  // so that high powers do not vanish
  for (std::size_t i = 0; i < guiding_.size(); ++i) {
    const double squared = guiding_.squared[i] * scale;
    if (squared < least) continue;
    const double importance =
        1e-4 + (options.power > 2 ? power_of(squared * unit, options.power - 2) : 1);
    const Foot foot =
        foot_on(frames_[static_cast<std::size_t>(guiding_.nearest[i])], guiding_.at(i));
    if (foot.weight == 0) continue;
    const double weighted = importance * foot.weight;
    matrix += weighted * foot.weight * foot.direction * foot.direction.transpose();
    right += weighted * foot.direction.dot(foot.residual) * foot.direction;
  }
  if (watch_back_ && sight_.triangle != kNoIndex && sight_.share > 0) {
    const double importance =
        options.power > 2 ? power_of(sight_.share * unit, options.power - 2) : 1;
    const Point residual = state_.back()->toward(at.position, sight_.triangle);
    const Point direction = residual.normalized();
    matrix += importance * direction * direction.transpose();
    right += importance * residual;
  }
  samples_.add_to(matrix, right, at.position, at.worst, options.power);
  if (spring_ > 0) {
    for (const std::uint32_t v : ring_)
      right += spring_ * (state_.mesh().position(v) - at.position);
    matrix.diagonal().array() += spring_ * static_cast<double>(ring_.size());
  }
  const double trace = matrix.trace();
  if (!(trace > 0)) return false;
  matrix.diagonal().array() += damping * trace;
  const double share = newton ? 1.0 / (options.power - 1) : 1;
  if (!options.in_place) {
    at.position += share * matrix.ldlt().solve(right);
    return true;
  }
  // The same in the directions of the place alone.
  const Eigen::Matrix3d along = place_->along(at.position);
  matrix = along * matrix * along + trace * (Eigen::Matrix3d::Identity() - along);
  at.position = place_->project(at.position + share * matrix.ldlt().solve(along * right));
  return true;
}

bool LocalSearch::fit(const Point& start, const Options& options, Fit& best) {
  const Point begun = options.in_place ? place_->project(start) : start;
  if (!evaluate(begun, options.power, best)) return false;
  if (steps_ == Steps::kNewton) return fit_by_newton(options, best);
  Fit at = best;
  for (int i = 0; i < options.steps; ++i) {
    if (!step(options, kFixedDamping, at)) break;
    Fit next;
    bool better = false;
    // A step that does not lower the energy is halved once.
    for (int halving = 0; halving < 2 && !better; ++halving) {
      if (halving > 0) at.position = 0.5 * (at.position + best.position);
      if (halving > 0 && options.in_place) at.position = place_->project(at.position);
      better = evaluate(at.position, options.power, next, best.energy);
    }
    if (!better) break;
    const bool enough = next.energy > (1 - options.gain) * best.energy;
    best = at = next;
    if (enough) break;
  }
  return true;
}

// From `best`, which was evaluated last. A step that does not lower the energy is tried again with
// more damping.
bool LocalSearch::fit_by_newton(const Options& options, Fit& best) {
  constexpr int kAttempts = 3;
  double damping = kLeastDamping;
  for (int i = 0; i < options.steps; ++i) {
    Fit next;
    bool better = false;
    for (int attempt = 0; attempt < kAttempts && !better; ++attempt) {
      Fit at = best;
      // The step is of the frames and sights of the position last evaluated.
      if (attempt > 0 && !evaluate(best.position, options.power, at)) return true;
      if (!step(options, damping, at)) return true;
      better = evaluate(at.position, options.power, next, best.energy);
      if (!better) damping *= kMoreDamping;
    }
    if (!better) break;
    damping = std::max(damping * kLessDamping, kLeastDamping);
    const bool enough = next.energy > (1 - options.gain) * best.energy;
    best = next;
    if (enough) break;
  }
  return true;
}

bool LocalSearch::serve_elsewhere(std::uint32_t point, MeshEdit::Answer& answer) const {
  const EditableMesh& mesh = state_.mesh();
  for (const Triangle& t : added_) {
    for (const std::uint32_t v : t) {
      if (v == vertex_) continue;
      mesh.for_each_slot_at(v, [&](std::uint32_t slot) {
        if (std::find(removed_.begin(), removed_.end(), slot) != removed_.end()) return;
        const double squared = squared_distance(state_.point(point), mesh.corners(slot));
        if (squared >= answer.squared_distance) return;
        answer.added = kNoIndex;
        answer.slot = slot;
        answer.squared_distance = squared;
      });
    }
  }
  return state_.permits_point(point, answer.squared_distance);
}

double LocalSearch::worst_of(std::uint32_t slot) {
  double worst = 0;
  state_.assigned().for_each(slot, [&](std::uint32_t p) {
    worst = std::max(worst, state_.assigned().squared_distance(p) / state_.squared_limit());
  });
  if (state_.back() == nullptr) return worst;
  const Triangle& t = state_.mesh().triangle(slot);
  for (std::size_t i = 0; i < 3; ++i) {
    worst = std::max({worst, state_.sight(t[i]).share, samples_.worst_on(t[i], t[(i + 1) % 3])});
  }
  return worst;
}

double LocalSearch::share_of_middle(const std::array<Point, 3>& corners, std::uint32_t near) const {
  return state_.back()->sight((corners[0] + corners[1] + corners[2]) / 3, near).share;
}

// Whether no new triangle's middle is farther from the reference than edges may be and than those
// of before were. What spans a pit or a gap is seldom restored.
bool LocalSearch::middles_are_near(const Point& position) const {
  const EditableMesh& mesh = state_.mesh();
  double farthest = 0;
  for (const Triangle& t : added_) {
    const Point& first = vertex_ == kNoIndex ? mesh.position(t[0]) : position;
    const std::uint32_t near = state_.sight(t[1]).triangle;
    farthest = std::max(farthest,
                        share_of_middle({first, mesh.position(t[1]), mesh.position(t[2])}, near));
  }
  return farthest <= kLoosenedEdge || std::ranges::any_of(removed_, [&](std::uint32_t slot) {
           const std::uint32_t near = state_.sight(mesh.triangle(slot)[0]).triangle;
           return share_of_middle(mesh.corners(slot), near) >= farthest;
         });
}

// Returns false where `limit` forbids one of the points.
bool LocalSearch::answer(std::span<const std::uint32_t> ids, LocalPoints& points, bool limit,
                         MeshEdit& edit) const {
  measure(points, frames_);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    MeshEdit::Answer answer{ids[i], static_cast<std::uint32_t>(points.nearest[i]), kNoIndex,
                            points.squared[i]};
    if (!state_.permits_point(ids[i], answer.squared_distance) &&
        !serve_elsewhere(ids[i], answer) && limit && !EMAX_FAULT(kSkipsPoints)) {
      return false;
    }
    edit.answers.push_back(answer);
  }
  return true;
}

bool LocalSearch::answer(std::span<const std::uint32_t> ids, bool limit, MeshEdit& edit) {
  points_.clear();
  for (const std::uint32_t p : ids) points_.push_back(state_.point(p));
  return answer(ids, points_, limit, edit);
}

// The guides first, then the others piece by piece: most edits that a point forbids are known
// early.
bool LocalSearch::answer_all(bool limit, MeshEdit& edit) {
  constexpr std::size_t kPiece = 4096;
  const bool measured = guiding_ids_.size() == ids_.size();
  if (!(measured ? answer(ids_, guiding_, limit, edit) : answer(ids_, limit, edit))) return false;
  others_.clear();
  for (const std::uint32_t slot : removed_) {
    state_.assigned().for_each_other(slot, [&](std::uint32_t p) { others_.push_back(p); });
  }
  const std::span<const std::uint32_t> others = others_;
  for (std::size_t i = 0; i < others.size(); i += kPiece) {
    if (!answer(others.subspan(i, std::min(kPiece, others.size() - i)), limit, edit)) return false;
  }
  return true;
}

bool LocalSearch::finish(const Fit& fit, bool limit, MeshEdit& edit) {
  edit.clear();
  if (!shape(fit.position)) return false;
  const bool edges_count = limit && state_.loosened() && !samples_.none();
  if (edges_count &&
      !(samples_.permits(fit.position, vertex_, kLoosenedEdge) && middles_are_near(fit.position))) {
    return false;
  }
  if (!answer_all(limit, edit)) return false;
  edit.vertex = vertex_;
  edit.position = fit.position;
  edit.removed = removed_;
  edit.added = added_;
  return true;
}

}  // namespace emax
