#include "host/genocop/finish.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace emax {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kLeastRadius = 1e-7;  // of the domains
constexpr double kFine = 1e-3;         // below this radius a gain below kPrecision ends the search
constexpr double kPrecision = 1e-11;   // of the objective
constexpr double kNear = 3;            // radii within which points span the model's directions
constexpr double kFar = 6;             // radii within which points determine the curvature
constexpr double kPoised = 0.1;        // share of a step that must be independent of the others

}  // namespace

Finish::Finish(const LinearDomain& domain, const Problem& problem,
               std::vector<std::size_t> coordinates)
    : domain_(domain), problem_(problem), coordinates_(std::move(coordinates)) {}

void Finish::start(const Genes& free, const Evaluation& evaluation, double radius) {
  stop();
  space_.emplace(domain_, problem_, coordinates_, free);
  if (space_->size() == 0) return;
  running_ = true;
  radius_ = radius;
  penalty_ = 0;
  scaled_ = false;
  failures_ = 0;
  predicts_well_ = false;
  told(free, evaluation);
  running_ = !points_.empty();
}

void Finish::stop() {
  running_ = false;
  points_.clear();
  trials_.clear();
  hessians_.clear();
  next_.reset();
  centre_ = 0;
}

double Finish::merit(const LocalPoint& point) const {
  return point.responses[0] + penalty_ * std::max(0.0, point.violation);
}

void Finish::choose_centre() {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (merit(points_[i]) < merit(points_[centre_])) centre_ = i;
  }
}

void Finish::asked(const Genes& free) {
  if (next_ && next_->free == free) trials_.push_back(std::move(*next_));
  next_.reset();
}

void Finish::told(const Genes& free, const Evaluation& evaluation) {
  if (!running_) return;
  const auto found = std::find_if(trials_.begin(), trials_.end(),
                                  [&](const Trial& trial) { return trial.free == free; });
  const bool own = found != trials_.end();
  const LocalPoint* added = nullptr;
  if (points_.empty() || space_->same_rest(free, *centre())) {
    std::optional<LocalPoint> point = space_->point(free, evaluation);
    if (!point) space_->failed(free);
    if (point && (own || points_.empty() ||
                  (point->at - points_[centre_].at).cwiseAbs().maxCoeff() <= kNear * radius_)) {
      points_.push_back(std::move(*point));
      added = &points_.back();
    }
  }
  if (own) {
    const Trial trial = std::move(*found);
    trials_.erase(found);
    if (added == nullptr) {
      shrink(0.9);  // it failed, and the space keeps the next ones away from it
    } else if (trial.reduction) {
      judge_step(trial, *added);
    }
  }
  if (added != nullptr) choose_centre();
}

void Finish::judge_step(const Trial& trial, const LocalPoint& point) {
  const double length = (trial.at - points_[centre_].at).cwiseAbs().maxCoeff();
  const double gained = merit(points_[centre_]) - merit(point);
  const double ratio = gained / *trial.reduction;
  predicts_well_ = ratio >= 0.2;
  // The steps may fail because of curvature from models farther away.
  constexpr int kMisled = 3;
  failures_ = ratio < 0.1 ? failures_ + 1 : 0;
  if (failures_ % kMisled == kMisled - 1) hessians_.clear();
  if (ratio < 0.1) {
    shrink(std::clamp(length / radius_, 0.2, 1.0) * 0.5);
  } else if (ratio > 0.7 && length > 0.8 * radius_) {
    radius_ = std::min(2 * radius_, 0.5);
  }
}

void Finish::shrink(double factor) {
  radius_ *= factor;
  if (radius_ < kLeastRadius) running_ = false;
}

// Selects the nearest points, first of all those whose steps have a direction of their own (a
// pivoted Gram-Schmidt process). If a direction is not spanned, `missing` becomes the point that
// adds most to it. Trials in flight count as evaluated.
Finish::Selection Finish::select() const {
  const Eigen::Index n = space_->size();
  const Vector& origin = points_[centre_].at;
  struct Entry {
    double distance;
    std::size_t index;  // from points_.size() on: in flight
  };
  std::vector<Entry> order;
  for (std::size_t i = 0; i < points_.size() + trials_.size(); ++i) {
    if (i == centre_) continue;
    const Vector& at = i < points_.size() ? points_[i].at : trials_[i - points_.size()].at;
    const double distance = (at - origin).cwiseAbs().maxCoeff();
    if (distance <= kFar * radius_ && distance > 1e-12) order.push_back({distance, i});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Entry& a, const Entry& b) { return a.distance < b.distance; });
  Matrix basis(n, n);
  Eigen::Index directions = 0;
  const auto rest = [&](Vector step) {
    for (int twice = 0; twice < 2; ++twice) {
      for (Eigen::Index d = 0; d < directions; ++d) step -= basis.col(d).dot(step) * basis.col(d);
    }
    return step;
  };
  Selection selection;
  std::vector<std::size_t> others;
  for (const Entry& entry : order) {
    const bool in_flight = entry.index >= points_.size();
    const Vector step =
        (in_flight ? trials_[entry.index - points_.size()].at : points_[entry.index].at) - origin;
    const Vector own = rest(step);
    if (directions < n && entry.distance <= kNear * radius_ &&
        own.norm() >= kPoised * step.norm()) {
      basis.col(directions++) = own.normalized();
      if (!in_flight) selection.points.push_back(entry.index);
    } else if (!in_flight) {
      others.push_back(entry.index);
    }
  }
  const auto most = static_cast<std::size_t>(std::min((n + 1) * (n + 2) / 2 - 1, 2 * n + 1));
  for (std::size_t i : others) {
    if (selection.points.size() >= most) break;
    selection.points.push_back(i);
  }
  if (directions == n) return selection;

  double best = 0.1 * kPoised * radius_;
  for (Eigen::Index axis = 0; axis < n; ++axis) {
    const Vector open = rest(Vector::Unit(n, axis));
    if (open.norm() < 1e-6) continue;
    for (const Vector& direction : {Vector(Vector::Unit(n, axis)), Vector(open.normalized())}) {
      for (const double sign : {1.0, -1.0}) {
        Genes free = space_->moved(points_[centre_].free, sign * radius_ * direction);
        if (space_->nears_a_failure(points_[centre_].free, free)) continue;
        const Vector step = space_->position(free) - origin;
        const double gain = rest(step).norm();
        // A gain that is just enough could count as too small at the next call because of rounding.
        if (gain <= 1.001 * best || gain < 1.001 * kPoised * step.norm()) continue;
        best = gain;
        selection.missing = std::move(free);
      }
    }
  }
  return selection;
}

LocalModel Finish::fit(const std::vector<std::size_t>& chosen) {
  const LocalPoint& centre = points_[centre_];
  const auto rows = static_cast<Eigen::Index>(chosen.size());
  Matrix steps(rows, space_->size());
  Matrix values(rows, centre.responses.size());
  for (Eigen::Index i = 0; i < rows; ++i) {
    const LocalPoint& point = points_[chosen[static_cast<std::size_t>(i)]];
    steps.row(i) = (point.at - centre.at).transpose();
    values.row(i) = point.responses.transpose();
  }
  LocalModel model = fit_quadratic(steps, values, centre.responses, hessians_);
  hessians_ = model.hessians;
  return model;
}

// Divides each constraint by how much it changes across the domain, as the first model has it, so
// that no constraint outweighs the others in the greatest violation.
void Finish::scale_constraints(const LocalModel& model) {
  scaled_ = true;
  const Eigen::Index count = model.gradients.cols() - 1;
  if (count < 2) return;
  constexpr double kLeast = 1e-6;  // of the greatest: a constraint may not change at all here
  Vector scales = model.gradients.rightCols(count).colwise().norm().transpose();
  scales = scales.cwiseMax(kLeast * scales.maxCoeff());
  if (!(scales.minCoeff() > 0) || !scales.allFinite()) return;
  scales /= std::exp(scales.array().log().mean());
  space_->scale(scales);
  for (LocalPoint& point : points_) space_->scale(point, scales);
}

std::optional<Genes> Finish::propose() {
  constexpr int kMostRounds = 100;
  for (int round = 0; running_; ++round) {
    if (round == kMostRounds) {
      running_ = false;
      break;
    }
    Selection selection = select();
    if (selection.missing) {
      const Vector at = space_->position(*selection.missing);
      next_ = Trial{*selection.missing, at, std::nullopt};
      return selection.missing;
    }
    if (!trials_.empty()) return std::nullopt;
    if (selection.points.empty()) {
      running_ = false;
      break;
    }
    LocalModel model = fit(selection.points);
    if (!scaled_) {
      scale_constraints(model);
      hessians_.clear();
      model = fit(selection.points);
    }
    const LocalStep step = best_step(*space_, *centre(), model, radius_, penalty_);
    // A penalty that was fitted far away would make every curved constraint a wall.
    constexpr double kAmple = 10;
    if (points_[centre_].violation <= 0 && penalty_ > kAmple * step.multipliers) {
      penalty_ = std::max(penalty_ / kAmple, 0.3 * kAmple * step.multipliers);
    }
    const std::size_t before = centre_;
    choose_centre();  // the penalty may have grown
    if (centre_ != before) continue;
    const double least = kPrecision * std::max(1.0, std::abs(points_[centre_].responses[0]));
    const double length = step.step.cwiseAbs().maxCoeff();
    if (!(step.reduction > least) || length < 1e-3 * kLeastRadius) {
      if (radius_ <= kFine) running_ = false;
      shrink(0.1);
      continue;
    }
    Genes free = space_->moved(*centre(), step.step);
    const Vector at = space_->position(free);
    if ((at - points_[centre_].at).cwiseAbs().maxCoeff() < 1e-13) {
      shrink(0.1);
      continue;
    }
    next_ = Trial{free, at, step.reduction};
    return free;
  }
  return std::nullopt;
}

}  // namespace emax
