#include "host/genocop/ranking.h"

namespace emax {

std::vector<double> ranking_probabilities(std::size_t count, double q) {
  std::vector<double> probabilities(count);
  double left = 1;  // (1-q)^i
  for (double& probability : probabilities) {
    probability = q * left;
    left *= 1 - q;
  }
  for (double& probability : probabilities) probability /= 1 - left;
  return probabilities;
}

std::size_t select(std::span<const double> weights, RandomStream& random) {
  double sum = 0;
  for (double weight : weights) sum += weight;
  const double mark = random.uniform() * sum;
  double passed = 0;
  std::size_t last = 0;  // with a positive weight; used only if the sum is rounded
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    passed += weights[i];
    if (mark < passed) return i;
    last = i;
  }
  return last;
}

}  // namespace emax
