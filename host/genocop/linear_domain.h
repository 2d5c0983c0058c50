#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <emax/genocop.h>
#include "host/genocop/random_stream.h"

namespace emax {

struct Interval {
  double lower;
  double upper;
};

// The set of points that the operators stay in: gene domains, whole integers and linear
// constraints. As in Genocop (Michalewicz & Janikow 1991), every equality is solved for one
// continuous gene. The other genes are the free coordinates, and the domain of a solved gene
// becomes two inequalities on them. All methods take and give free coordinates, except complete()
// and reduce().
class LinearDomain {
 public:
  // Throws emax::Error if there are no genes, a domain is empty, a start lies outside, the
  // equalities contradict each other or leave no continuous gene to solve for, a linear constraint
  // or the monotone gene names a categorical or missing gene, Gene::only_with is not as its
  // declaration requires, or no point is found inside.
  explicit LinearDomain(const Problem& problem);

  std::size_t size() const { return free_.size(); }
  Genes complete(const Genes& free) const;
  Genes reduce(const Genes& genes) const;

  // Exact: each inequality is summed in double in the order of its terms and compared without a
  // tolerance. Equalities hold up to the rounding of their solved gene.
  bool contains(const Genes& free) const;

  // The interval in which coordinate k may move while the others stay. It is never empty, contains
  // free[k] up to rounding, and has whole ends for an integer. O(rows * coordinates).
  Interval range(const Genes& free, std::size_t k) const;

  // The point nearest to `child` on the segment from `anchor`, which is inside, that is inside
  // after integers are rounded; the anchor itself if there is no other.
  Genes pull_inside(const Genes& child, const Genes& anchor) const;

  // The point for a position in the unit cube. If it is outside the constraints, the point is the
  // end of a random walk.
  Genes from_unit_cube(const std::vector<double>& position, RandomStream& random) const;
  Genes sample(RandomStream& random) const;

  // Whether coordinate k has a meaning with the categories of the point (Gene::only_with).
  bool has_meaning(const Genes& free, std::size_t k) const {
    const auto& condition = conditions_[k];
    return !condition || condition->holds(free[condition->gene]);
  }
  // The movable coordinates that have a meaning there.
  std::vector<std::size_t> movable_with_meaning(const Genes& free) const;

  const Genes& inside() const { return inside_; }  // one point that is inside
  const Gene& gene(std::size_t k) const { return genes_[free_[k]]; }
  const std::vector<std::size_t>& movable() const { return movable_; }  // lower < upper
  // The domains of solved genes and the inequalities: sum of weight * free <= bound.
  struct Row {
    std::vector<double> weights;
    double bound;
  };
  const std::vector<Row>& rows() const { return rows_; }
  // The coordinate of a gene, or size() if an equality determines the gene.
  std::size_t coordinate(std::size_t gene) const;

 private:
  struct Solved {  // gene = constant + sum of weight * free
    std::size_t gene;
    double constant;
    std::vector<double> weights;
  };

  void solve_equalities(const Problem& problem);
  void reduce_inequalities();
  void add_row(Row row);
  void find_inside(const Problem& problem);
  Genes snap(const Genes& free) const;

  std::vector<Gene> genes_;
  std::vector<LinearConstraint> inequalities_;
  std::vector<std::size_t> free_;
  std::vector<std::size_t> movable_;
  std::vector<std::optional<Gene::Condition>> conditions_;  // genes are coordinates
  std::vector<Solved> solved_;
  std::vector<Row> rows_;
  Genes inside_;
};

}  // namespace emax
