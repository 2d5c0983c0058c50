#include "host/genocop/monotone_step.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace emax {
namespace {

bool better(const Evaluation& a, const Evaluation& b) {
  if (a.feasible() != b.feasible()) return a.feasible();
  return a.feasible() ? a.objective < b.objective : a.violation < b.violation;
}

bool usable(const std::optional<Evaluation>& evaluation) {
  return evaluation && evaluation->evaluated_ok;
}

}  // namespace

MonotoneStep::MonotoneStep(const LinearDomain& domain, std::size_t coordinate,
                           const Settings& settings)
    : domain_(domain),
      coordinate_(coordinate),
      most_in_flight_(settings.monotone_in_flight),
      gain_(settings.monotone_gain) {
  for (std::size_t k = 0; k < domain.size(); ++k) {
    const bool counted = std::ranges::any_of(
        domain.rows(), [k](const LinearDomain::Row& row) { return row.weights[k] != 0; });
    if (k != coordinate && !counted) loose_.push_back(k);
  }
}

Genes MonotoneStep::line_of(Genes genes) const {
  genes[coordinate_] = 0;
  for (const std::size_t k : loose_) {
    if (!domain_.has_meaning(genes, k)) genes[k] = domain_.gene(k).lower;
  }
  return genes;
}

// The gain that is still possible shrinks about as one over the number of trials.
double MonotoneStep::gain() const {
  constexpr double kEarly = 150;
  return gain_ * std::min(1.0, kEarly / static_cast<double>(asked_ + 1));
}

void MonotoneStep::asked(const Genes& genes) {
  ++asked_;
  lines_[line_of(genes)].try_emplace(genes[coordinate_]);
}

void MonotoneStep::told(const Genes& genes, const Evaluation& evaluation) {
  lines_[line_of(genes)][genes[coordinate_]] = evaluation;
  if (!evaluation.evaluated_ok) return;
  if (!incumbent_evaluation_ || better(evaluation, *incumbent_evaluation_)) {
    incumbent_ = genes;
    incumbent_evaluation_ = evaluation;
  }
  if (same_line(genes, incumbent_)) measure_slopes();
}

// Measures the slopes over points around the constraint that are far enough apart, so that the
// jumps of a rough violation do not decide. Keeps the old slopes while the incumbent's line has too
// few points.
void MonotoneStep::measure_slopes() {
  constexpr double kSpan = 0.15;  // of the violation, which is normalised
  const Line& line = lines_.at(line_of(incumbent_));
  std::vector<std::pair<double, Evaluation>> points;
  std::size_t lower = 0;
  for (const auto& [value, evaluation] : line) {
    if (!usable(evaluation)) continue;
    if (value <= incumbent_[coordinate_]) lower = points.size();
    points.emplace_back(value, *evaluation);
  }
  std::size_t upper = lower;
  while (points[upper].second.violation - points[lower].second.violation < kSpan) {
    const bool can_rise = upper + 1 < points.size();
    if (can_rise && (lower == 0 || upper - lower < 2 ||
                     std::abs(points[upper + 1].second.violation) <
                         std::abs(points[lower - 1].second.violation))) {
      ++upper;
    } else if (lower > 0) {
      --lower;
    } else {
      break;
    }
  }
  if (lower == upper) return;
  const double width = points[upper].first - points[lower].first;
  const double rise = (points[upper].second.violation - points[lower].second.violation) / width;
  const double fall = (points[upper].second.objective - points[lower].second.objective) / width;
  if (rise <= 0 || fall >= 0) return;
  rise_ = rise;
  fall_ = fall;
}

// The bracket between the greatest feasible value and the least infeasible value above it.
MonotoneStep::Bracket MonotoneStep::bracket(const Genes& key, const Line& line) const {
  const Interval range = domain_.range(key, coordinate_);
  Bracket result{range.lower, range.upper, {}, {}};
  for (const auto& [value, evaluation] : line) {
    if (!evaluation || !evaluation->feasible()) continue;
    result.lower = value;
    result.at_lower = evaluation;
  }
  for (const auto& [value, evaluation] : line) {
    if (!evaluation || evaluation->feasible()) continue;
    if (result.at_lower && value <= result.lower) continue;
    result.upper = value;
    result.at_upper = evaluation;
    break;
  }
  return result;
}

// The predicted root of the violation, inside the bracket.
double MonotoneStep::root(const Bracket& b) const {
  constexpr double kLeastShrinkage = 0.25;  // a bracket shrinks at least by this share
  const double width = b.upper - b.lower;
  if (b.at_lower && b.at_upper) {
    double share = 0.5;
    if (b.at_upper->evaluated_ok && b.at_upper->violation > b.at_lower->violation) {
      share = -b.at_lower->violation / (b.at_upper->violation - b.at_lower->violation);
    }
    return b.lower + std::clamp(share, kLeastShrinkage, 1 - kLeastShrinkage) * width;
  }
  if (rise_ > 0 && b.at_lower) {
    return std::min(b.lower - b.at_lower->violation / rise_, b.upper);
  }
  if (rise_ > 0 && usable(b.at_upper)) {
    return std::max(b.upper - b.at_upper->violation / rise_, b.lower);
  }
  return b.lower + width / 2;
}

std::optional<Genes> MonotoneStep::climb() const {
  if (!incumbent_evaluation_) return std::nullopt;
  if (!incumbent_evaluation_->feasible() || rise_ <= 0) {
    const Genes key = line_of(incumbent_);
    return trial(key, lines_.at(key));
  }
  const double best = incumbent_evaluation_->objective;
  double least = best - gain() * std::abs(best);
  const std::pair<const Genes, Line>* chosen = nullptr;
  for (const auto& entry : lines_) {
    const Bracket b = bracket(entry.first, entry.second);
    const std::optional<Evaluation>& known = b.at_lower ? b.at_lower : b.at_upper;
    if (!usable(known)) continue;
    const double from = b.at_lower ? b.lower : b.upper;
    const double predicted = known->objective + fall_ * (root(b) - from);
    if (predicted < least && trial(entry.first, entry.second)) {
      least = predicted;
      chosen = &entry;
    }
  }
  if (chosen == nullptr) return std::nullopt;
  return trial(chosen->first, chosen->second);
}

std::optional<Genes> MonotoneStep::trial(const Genes& key, const Line& line) const {
  const Bracket b = bracket(key, line);
  const Gene& gene = domain_.gene(coordinate_);
  constexpr double kFinest = 1e-9;  // of the domain
  const double width = b.upper - b.lower;
  if (!(width > kFinest * (gene.upper - gene.lower))) return std::nullopt;

  const double aim = root(b);
  // The ends of the interval that may hold the root, and the trials in flight between them.
  const bool open_above = !b.at_upper && rise_ > 0;
  const double end = open_above ? std::min(b.upper, aim + (aim - b.lower)) : b.upper;
  std::vector<double> marks{b.lower};
  std::size_t in_flight = 0;
  for (const auto& [value, evaluation] : line) {
    if (evaluation || value < b.lower || value > b.upper) continue;
    ++in_flight;
    if (value > b.lower && value < end) marks.push_back(value);
  }
  marks.push_back(end);
  if (in_flight >= most_in_flight_) return std::nullopt;

  double value = aim;
  if (!b.at_lower && rise_ <= 0 && !line.contains(b.lower)) {
    value = b.lower;  // if this value is infeasible, so is the whole line
  } else if (in_flight > 0) {
    std::size_t widest = 1;
    for (std::size_t i = 2; i < marks.size(); ++i) {
      if (marks[i] - marks[i - 1] > marks[widest] - marks[widest - 1]) widest = i;
    }
    value = marks[widest - 1] + (marks[widest] - marks[widest - 1]) / 2;
  }
  Genes anchor = key;
  anchor[coordinate_] = line.begin()->first;
  Genes point = anchor;
  point[coordinate_] = value;
  point = domain_.pull_inside(point, anchor);
  if (line.contains(point[coordinate_])) return std::nullopt;
  return point;
}

Genes MonotoneStep::aim(const Genes& child, const Genes& parent,
                        const Evaluation& parent_evaluation) const {
  if (rise_ <= 0 || !incumbent_evaluation_->feasible()) return child;
  const double objective = incumbent_evaluation_->objective;
  if (objective <= 0) return child;
  // Every line's objective is taken as rate * (zero - gene), with one zero for all lines and a rate
  // for each.
  const double zero = incumbent_[coordinate_] - objective / fall_;
  double rate = -fall_;
  double known_value = parent[coordinate_];
  Evaluation known = parent_evaluation;
  if (const auto own = lines_.find(line_of(child)); own != lines_.end()) {
    for (const auto& [value, evaluation] : own->second) {
      if (!usable(evaluation)) continue;
      known_value = value;
      known = *evaluation;
    }
  }
  if (known.objective > 0 && known_value < zero) rate = known.objective / (zero - known_value);
  Genes aimed = child;
  aimed[coordinate_] = zero - (1 - gain()) * objective / rate;
  if (domain_.gene(coordinate_).is_whole()) {
    aimed[coordinate_] = std::ceil(aimed[coordinate_]);
  }
  return domain_.pull_inside(aimed, child);
}

}  // namespace emax
