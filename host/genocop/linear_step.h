#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "host/genocop/local_model.h"
#include "host/genocop/random_stream.h"

namespace emax {

// An operator on all genes that have an order, whole ones included: linear models of objective and
// constraints by least squares over the evaluated points nearest to the best one, and the model's
// best point in a trust region around it. No evaluation is spent on the models. The categories are
// the best point's, and only points that share them count.
class LinearStep {
 public:
  // `coordinates`: movable ones that have an order, at least one. Domain and problem outlive it.
  LinearStep(const LinearDomain& domain, const Problem& problem,
             std::vector<std::size_t> coordinates);

  void told(const Genes& free, const Evaluation& evaluation);
  // A step from `centre`; none before enough points are known. O(points).
  std::optional<Genes> propose(const Genes& centre, const Evaluation& evaluation,
                               RandomStream& random) const;
  // What became of a step.
  void judge(bool improved);
  double radius() const { return radius_; }

 private:
  // Points in which the same coordinates have a meaning.
  struct Region {
    LocalSpace space;
    std::vector<LocalPoint> points;
  };
  std::vector<bool> meanings(const Genes& free) const;

  const LinearDomain& domain_;
  const Problem& problem_;
  std::vector<std::size_t> coordinates_;
  std::map<std::vector<bool>, Region> regions_;
  double radius_;
};

}  // namespace emax
