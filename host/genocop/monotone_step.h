#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "host/genocop/linear_domain.h"
#include "host/genocop/settings.h"

namespace emax {

// The use of a gene along which, all others held, the objective falls and the violation rises. A
// line is the set of points that differ in that gene alone, or also in genes without a meaning that
// no linear constraint counts; the best of a line lies where its
// violation passes zero. From the two slopes measured near the incumbent every evaluated point
// predicts the objective its line ends in, so points at different values of the gene compare, and
// only lines that promise to beat the incumbent are followed. Nothing is taken as proven: where the
// violation is only nearly monotone this costs trials, never a wrong best. O(points) a call.
class MonotoneStep {
 public:
  MonotoneStep(const LinearDomain& domain, std::size_t coordinate, const Settings& settings);

  void asked(const Genes& genes);
  void told(const Genes& genes, const Evaluation& evaluation);

  // The next trial on the most promising line: the predicted root of the violation, kept off the
  // ends of a bracket; the widest gap is halved while the root is in flight. None where no line
  // with fewer than monotone_in_flight trials out promises gain() of the best objective. While
  // nothing is feasible, the line of the least violation is followed downwards, its lower end
  // first.
  std::optional<Genes> climb() const;

  // The child moved along its line to where it is predicted to beat the incumbent by gain(), its
  // objective being to the incumbent's as its parent's was. The child itself where nothing can
  // be predicted.
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
  std::vector<std::size_t> loose_;  // coordinates of no linear constraint
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
