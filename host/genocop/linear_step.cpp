#include "host/genocop/linear_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace emax {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFirstRadius = 0.2;  // of the domains
constexpr double kMostRadius = 0.5;
constexpr double kRestartRadius = 0.01;  // below this the radius starts again at kFirstRadius

}  // namespace

LinearStep::LinearStep(const LinearDomain& domain, const Problem& problem,
                       std::vector<std::size_t> coordinates)
    : domain_(domain),
      problem_(problem),
      coordinates_(std::move(coordinates)),
      radius_(kFirstRadius) {}

std::vector<bool> LinearStep::meanings(const Genes& free) const {
  std::vector<bool> have(domain_.size());
  for (std::size_t k = 0; k < have.size(); ++k) have[k] = domain_.has_meaning(free, k);
  return have;
}

void LinearStep::told(const Genes& free, const Evaluation& evaluation) {
  auto region = regions_.find(meanings(free));
  if (region == regions_.end()) {
    region = regions_
                 .try_emplace(meanings(free),
                              Region{LocalSpace(domain_, problem_, coordinates_, free), {}})
                 .first;
  }
  if (auto point = region->second.space.point(free, evaluation)) {
    region->second.points.push_back(std::move(*point));
  } else {
    region->second.space.failed(free);
  }
}

std::optional<Genes> LinearStep::propose(const Genes& centre, const Evaluation& evaluation,
                                         RandomStream& random) const {
  const auto region = regions_.find(meanings(centre));
  if (region == regions_.end() || region->second.space.size() == 0) return std::nullopt;
  const auto& [space, points] = region->second;
  const std::optional<LocalPoint> origin = space.point(centre, evaluation);
  if (!origin) return std::nullopt;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i].at - origin->at).squaredNorm();
    if (distance > 0 && space.same_rest(points[i].free, centre)) order.emplace_back(distance, i);
  }
  const auto n = static_cast<std::size_t>(space.size());
  if (order.size() < n + 1) return std::nullopt;
  const std::size_t count = std::min(order.size(), 2 * n + 3);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  order.resize(count);
  Matrix steps(static_cast<Eigen::Index>(count), space.size());
  Matrix values(static_cast<Eigen::Index>(count), origin->responses.size());
  Vector weights(static_cast<Eigen::Index>(count));
  const double reach = order[count / 2].first;
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const LocalPoint& point = points[order[i].second];
    steps.row(row) = (point.at - origin->at).transpose();
    values.row(row) = point.responses.transpose();
    weights[row] = 1 / (reach + order[i].first);
  }
  const LocalModel model = fit_linear(steps, values, origin->responses, weights);
  double penalty = 0;
  const double radius = radius_ * random.uniform(0.5, 1.5);
  const LocalStep step = best_step(space, centre, model, radius, penalty);
  if (!(step.reduction > 0)) return std::nullopt;
  return space.moved(centre, step.step);
}

void LinearStep::judge(bool improved) {
  radius_ = improved ? std::min(1.6 * radius_, kMostRadius) : 0.8 * radius_;
  if (radius_ < kRestartRadius) radius_ = kFirstRadius;
}

}  // namespace emax
