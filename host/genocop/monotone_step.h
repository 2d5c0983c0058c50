#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "host/genocop/linear_domain.h"
#include "host/genocop/settings.h"

namespace emax {

// Uses a gene along which, with all others held, the objective falls and the violation rises. A
// line is a set of points that differ only in this gene, or also in genes that have no meaning
// there and are in no linear constraint. The best point of a line is where its violation passes
// zero. With two slopes that are measured near the incumbent, every evaluated point predicts the
// objective at the end of its line. So points at different values of the gene are comparable, and
// only lines that promise to beat the incumbent are followed. The predictions are not trusted as
// proofs: where the violation is only nearly monotone they cost trials, but never give a wrong best
// point. O(points) a call.
class MonotoneStep {
 public:
  MonotoneStep(const LinearDomain& domain, std::size_t coordinate, const Settings& settings);

  void asked(const Genes& genes);
  void told(const Genes& genes, const Evaluation& evaluation);

  // The next trial on the most promising line: the predicted root of the violation, kept away from
  // the ends of a bracket. While trials of the line are in flight, the widest gap is halved
  // instead. Nothing if no line with fewer than monotone_in_flight trials in flight promises gain()
  // of the best objective. While nothing is feasible, the line of the least violation is followed
  // downwards, its lower end first.
  std::optional<Genes> climb() const;

  // Moves the child along its line to where it is predicted to beat the incumbent by gain(),
  // assuming that the child's objective relates to the incumbent's as its parent's does. Returns
  // the child itself where nothing can be predicted.
  Genes aim(const Genes& child, const Genes& parent, const Evaluation& parent_evaluation) const;

  // -(d objective / d violation) near the incumbent, the price of violation; 0 while unknown.
  double price() const { return rise_ > 0 ? -fall_ / rise_ : 0; }

  bool same_line(const Genes& a, const Genes& b) const { return line_of(a) == line_of(b); }

 private:
  using Line = std::map<double, std::optional<Evaluation>>;  // empty while in flight
  struct Bracket {  // ends without an evaluation are ends of the range
    double lower;
    double upper;
    std::optional<Evaluation> at_lower;
    std::optional<Evaluation> at_upper;
  };

  double gain() const;
  Genes line_of(Genes genes) const;
  Bracket bracket(const Genes& key, const Line& line) const;
  double root(const Bracket& b) const;
  std::optional<Genes> trial(const Genes& key, const Line& line) const;
  void measure_slopes();

  const LinearDomain& domain_;
  std::size_t coordinate_;
  std::vector<std::size_t> loose_;  // coordinates in no linear constraint
  std::size_t most_in_flight_;
  double gain_;
  std::size_t asked_ = 0;
  std::map<Genes, Line> lines_;
  Genes incumbent_;  // the best feasible point, else the least violating one
  std::optional<Evaluation> incumbent_evaluation_;
  double rise_ = 0;  // d violation / d gene, > 0 once measured
  double fall_ = 0;  // d objective / d gene, < 0 once measured
};

}  // namespace emax
