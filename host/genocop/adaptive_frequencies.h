#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/genocop/random_stream.h"

namespace emax {

// Operator frequencies that follow success (probability matching; Davis 1989, Thierens 2005). An
// operator's quality is the mean reward of its offspring, in which recent offspring count more. Its
// frequency is floor/n + (1 - floor) * its share of the quality. Operators with an initial
// frequency of 0 are not used. The frequencies sum to 1.
class AdaptiveFrequencies {
 public:
  // `initial`: the shares to start from; none negative, at least one above 0.
  AdaptiveFrequencies(std::span<const double> initial, double floor);

  std::size_t draw(RandomStream& random) const;
  void reward(std::size_t entry, double amount);  // 0 to 1, for one offspring
  const std::vector<double>& frequencies() const { return frequencies_; }

 private:
  void update();

  double floor_;
  std::size_t used_ = 0;
  std::vector<double> initial_;
  std::vector<double> quality_;
  std::vector<double> frequencies_;
};

}  // namespace emax
