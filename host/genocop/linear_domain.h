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

// The set the operators are closed on: gene domains, whole integers and linear constraints. As in
// Genocop (Michalewicz & Janikow 1991), every equality is solved for one continuous gene; the
// remaining genes are the free coordinates, and the domain of a solved gene becomes two
// inequalities on them. All methods but complete(), reduce() take and give free coordinates.
class LinearDomain {
 public:
  // Throws emax::Error when there are no genes, a domain is empty, a start lies outside, the
  // equalities contradict each other or leave no continuous gene to solve for, a linear constraint
  // or the monotone gene is a categorical gene or none, Gene::only_with is not as its declaration
  // says, or no point is found inside.
  explicit LinearDomain(const Problem& problem);

  std::size_t size() const { return free_.size(); }
  Genes complete(const Genes& free) const;
  Genes reduce(const Genes& genes) const;

  // Exact: each inequality is summed in the order of its terms in double and compared without a
  // tolerance. Equalities hold to the rounding of their solved gene.
  bool contains(const Genes& free) const;

  // Where coordinate k may go while the others stay; never empty, holds free[k] up to rounding;
  // whole ends for an integer. O(rows * coordinates).
  Interval range(const Genes& free, std::size_t k) const;

  // The point of the segment from anchor (inside) to child nearest to child that is inside, after
  // integers are rounded; in the end the anchor itself.
  Genes pull_inside(const Genes& child, const Genes& anchor) const;

  // A point for each unit-cube position; outside the constraints it is replaced by a random walk.
  Genes from_unit_cube(const std::vector<double>& position, RandomStream& random) const;
  Genes sample(RandomStream& random) const;

  // Whether coordinate k means anything beside the categories of the point (Gene::only_with).
  bool has_meaning(const Genes& free, std::size_t k) const {
    const auto& condition = conditions_[k];
    return !condition || condition->holds(free[condition->gene]);
  }
  // Coordinates that may move and mean something there.
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
  // The coordinate of a gene, or size() when an equality determines it.
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
