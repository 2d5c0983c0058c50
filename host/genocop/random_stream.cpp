#include "host/genocop/random_stream.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace emax {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = std::uint64_t{0xD2511F53u} * counter[0];
    const std::uint64_t product1 = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product0)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t index, Purpose purpose)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
      counter_{0, static_cast<std::uint32_t>(purpose), static_cast<std::uint32_t>(index),
               static_cast<std::uint32_t>(index >> 32)} {}

std::uint64_t RandomStream::bits() {
  if (used_ == 4) {
    block_ = philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  const std::uint64_t low = block_[used_];
  const std::uint64_t high = block_[used_ + 1];
  used_ += 2;
  return high << 32 | low;
}

double RandomStream::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double RandomStream::uniform(double lower, double upper) {
  return std::clamp(lower + uniform() * (upper - lower), lower, upper);
}

std::uint64_t RandomStream::below(std::uint64_t count) {
  // Values below 2^64 mod count would make the small remainders too frequent.
  const std::uint64_t excess = (0 - count) % count;
  std::uint64_t value = bits();
  while (value < excess) value = bits();
  return value % count;
}

// von Neumann's rule: the length of the falling run p > u1 > u2 > ... is even with that
// probability.
bool RandomStream::bernoulli_exp(double p) {
  bool even = true;
  for (double previous = p;;) {
    const double next = uniform();
    if (next >= previous) return even;
    previous = next;
    even = !even;
  }
}

// Algorithm N of Karney 2016, "Sampling exactly from the normal distribution".
double RandomStream::gaussian() {
  for (;;) {
    int whole = 0;
    while (bernoulli_exp(0.5)) ++whole;
    bool accepted = true;
    for (int trial = whole * (whole - 1); accepted && trial > 0; --trial) {
      accepted = bernoulli_exp(0.5);
    }
    if (!accepted) continue;
    const double fraction = uniform();
    const double p = fraction * (2.0 * whole + fraction) / (2.0 * whole + 2.0);
    for (int trial = 0; accepted && trial <= whole; ++trial) accepted = bernoulli_exp(p);
    if (!accepted) continue;
    const double magnitude = whole + fraction;
    return (bits() >> 63) != 0 ? -magnitude : magnitude;
  }
}

std::vector<std::size_t> RandomStream::permutation(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[below(i)]);
  return order;
}

}  // namespace emax
