#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <emax/genocop.h>
#include "host/genocop/linear_domain.h"
#include "host/genocop/random_stream.h"

namespace emax {

// Differential evolution, DE/rand/1/bin (Storn & Price 1997), one member after the other: a trial
// takes about half of its genes from its member and the rest from another member, moved by half of
// the difference of two more. It replaces its member if it is at least as good; feasible points are
// better than others, which count by their violation (Deb 2000). Once the members are all alike the
// population begins anew.
class DifferentialEvolution {
 public:
  struct Trial {
    Genes free;
    std::size_t member;  // that it competes with
  };

  // The domain must outlive the object.
  explicit DifferentialEvolution(const LinearDomain& domain);

  std::size_t size() const { return members_.size(); }
  // `start` makes the point of a member that has none. Nothing while too few members are known.
  // O(genes * members).
  std::optional<Trial> propose(const std::function<Genes()>& start, RandomStream& random);
  void told(std::size_t member, const Genes& free, const Evaluation& evaluation);

 private:
  struct Member {
    Genes free;
    Evaluation evaluation;
  };

  Genes child(const Member& member, const Member& base, const Member& plus, const Member& minus,
              RandomStream& random) const;
  bool all_alike() const;

  const LinearDomain& domain_;
  std::vector<std::optional<Member>> members_;  // nothing: none was evaluated yet
  std::size_t next_ = 0;
};

}  // namespace emax
