#include "host/genocop/adaptive_frequencies.h"

#include "host/genocop/ranking.h"

namespace emax {

AdaptiveFrequencies::AdaptiveFrequencies(std::span<const double> initial, double floor)
    : floor_(floor),
      initial_(initial.begin(), initial.end()),
      quality_(initial.size(), 0.5),
      frequencies_(initial.size()) {
  double sum = 0;
  for (double frequency : initial_) {
    sum += frequency;
    used_ += frequency > 0;
  }
  for (double& frequency : initial_) frequency /= sum;
  update();
}

std::size_t AdaptiveFrequencies::draw(RandomStream& random) const {
  return select(frequencies_, random);
}

void AdaptiveFrequencies::reward(std::size_t entry, double amount) {
  constexpr double kMemory = 0.1;  // weight of the newest reward
  quality_[entry] += kMemory * (amount - quality_[entry]);
  update();
}

void AdaptiveFrequencies::update() {
  constexpr double kLeast = 1e-3;  // no quality becomes 0, so that the shares stay defined
  double sum = 0;
  for (std::size_t i = 0; i < initial_.size(); ++i) sum += initial_[i] * (quality_[i] + kLeast);
  for (std::size_t i = 0; i < initial_.size(); ++i) {
    frequencies_[i] = initial_[i] == 0
                          ? 0
                          : floor_ / static_cast<double>(used_) +
                                (1 - floor_) * initial_[i] * (quality_[i] + kLeast) / sum;
  }
}

}  // namespace emax
