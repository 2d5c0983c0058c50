#include "host/genocop/repair.h"

#include <algorithm>
#include <utility>

namespace emax {

RepairChain::RepairChain(RepairMethod method, Genes search, double search_violation,
                         Genes reference, double reference_violation)
    : method_(method),
      search_(std::move(search)),
      reference_(std::move(reference)),
      feasible_violation_(reference_violation),
      infeasible_violation_(search_violation) {}

Genes RepairChain::next(const LinearDomain& domain, RandomStream& random) {
  ++tries_;
  switch (method_) {
    case RepairMethod::kRandom:
      share_ = random.uniform();
      break;
    case RepairMethod::kDeterministic:
      share_ /= 2;
      break;
    case RepairMethod::kValueAware: {
      constexpr double kMargin = 0.05;  // of the bracket: a trial at its end gives no information
      const double rise = infeasible_violation_ - feasible_violation_;
      const double root = rise > 0 ? -feasible_violation_ / rise : 0.5;
      share_ = feasible_share_ +
               std::clamp(root, kMargin, 1 - kMargin) * (infeasible_share_ - feasible_share_);
      break;
    }
  }
  Genes point(search_.size());
  for (std::size_t k = 0; k < point.size(); ++k) {
    const bool ordered = domain.gene(k).kind != Gene::Kind::kCategorical;
    const double share = ordered ? share_ : share_ > 0.5 ? 1 : 0;
    point[k] = share * search_[k] + (1 - share) * reference_[k];
  }
  return domain.pull_inside(point, reference_);
}

void RepairChain::tell(const Evaluation& evaluation) {
  if (evaluation.feasible()) {
    feasible_share_ = share_;
    feasible_violation_ = evaluation.violation;
    return;
  }
  infeasible_share_ = share_;
  if (evaluation.evaluated_ok) infeasible_violation_ = evaluation.violation;
  // The Illinois rule: an end that stays counts half, so that the bracket shrinks from both sides.
  feasible_violation_ /= 2;
}

}  // namespace emax
