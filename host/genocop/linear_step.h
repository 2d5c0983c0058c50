#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "host/genocop/local_model.h"
#include "host/genocop/random_stream.h"

namespace emax {

// An operator on all genes with an order, including whole ones. It fits linear models of objective
// and constraints, by least squares over the evaluated points nearest to the best one, and proposes
// the model's best point in a trust region. The models need no evaluations of their own. The
// categories stay those of the best point, and only points with the same categories count.
class LinearStep {
 public:
  // `coordinates`: movable coordinates with an order, at least one. Domain and problem must outlive
  // this.
  LinearStep(const LinearDomain& domain, const Problem& problem,
             std::vector<std::size_t> coordinates);

  void told(const Genes& free, const Evaluation& evaluation);
  // A step from `centre`; nothing while too few points are known. O(points).
  std::optional<Genes> propose(const Genes& centre, const Evaluation& evaluation,
                               RandomStream& random) const;
  void forget() { regions_.clear(); }  // all points that were told
  // Takes whether a proposed step improved the best point.
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
