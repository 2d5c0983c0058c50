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
constexpr double kLeastRadius = 0.01;  // then the search begins anew with the first

}  // namespace

LinearStep::LinearStep(const LinearDomain& domain, const Problem& problem,
                       std::vector<std::size_t> coordinates)
    : space_(domain, problem, std::move(coordinates)), radius_(kFirstRadius) {}

void LinearStep::told(const Genes& free, const Evaluation& evaluation) {
  if (auto point = space_.point(free, evaluation)) points_.push_back(std::move(*point));
}

std::optional<Genes> LinearStep::propose(const Genes& centre, const Evaluation& evaluation,
                                         RandomStream& random) const {
  const std::optional<LocalPoint> origin = space_.point(centre, evaluation);
  if (!origin) return std::nullopt;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double distance = (points_[i].at - origin->at).squaredNorm();
    if (distance > 0 && space_.same_rest(points_[i].free, centre)) order.emplace_back(distance, i);
  }
  const auto n = static_cast<std::size_t>(space_.size());
  if (order.size() < n + 1) return std::nullopt;
  const std::size_t count = std::min(order.size(), 2 * n + 3);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  order.resize(count);
  Matrix steps(static_cast<Eigen::Index>(count), space_.size());
  Matrix values(static_cast<Eigen::Index>(count), origin->responses.size());
  Vector weights(static_cast<Eigen::Index>(count));
  const double reach = order[count / 2].first;
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const LocalPoint& point = points_[order[i].second];
    steps.row(row) = (point.at - origin->at).transpose();
    values.row(row) = point.responses.transpose();
    weights[row] = 1 / (reach + order[i].first);
  }
  const LocalModel model = fit_linear(steps, values, origin->responses, weights);
  double penalty = 0;
  const double radius = radius_ * random.uniform(0.5, 1.5);
  const LocalStep step = best_step(space_, centre, model, radius, penalty);
  if (!(step.reduction > 0)) return std::nullopt;
  return space_.moved(centre, step.step);
}

void LinearStep::judge(bool improved) {
  radius_ = improved ? std::min(1.6 * radius_, kMostRadius) : 0.8 * radius_;
  if (radius_ < kLeastRadius) radius_ = kFirstRadius;
}

}  // namespace emax
