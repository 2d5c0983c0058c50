#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "host/genocop/linear_domain.h"
#include "host/genocop/settings.h"

namespace emax {

// The repair of one infeasible search point s towards a feasible reference point r. It makes trials
// z = a s + (1-a) r (Michalewicz & Nazhiyath 1995) one after another, until one is feasible. A
// category is that of the nearer of the two points.
class RepairChain {
 public:
  RepairChain(RepairMethod method, Genes search, double search_violation, Genes reference,
              double reference_violation);

  Genes next(const LinearDomain& domain, RandomStream& random);  // inside the domain
  void tell(const Evaluation& evaluation);                       // of the last next()
  std::size_t tries() const { return tries_; }

  std::uint64_t search_id = 0;  // used by the caller
  std::uint64_t reference_id = 0;
  double reference_objective = 0;
  std::optional<std::size_t> bred_by;  // operator of the search point

 private:
  RepairMethod method_;
  Genes search_;
  Genes reference_;
  double share_ = 1;  // a of the last trial
  double feasible_share_ = 0;
  double feasible_violation_;
  double infeasible_share_ = 1;
  double infeasible_violation_;
  std::size_t tries_ = 0;
};

}  // namespace emax
