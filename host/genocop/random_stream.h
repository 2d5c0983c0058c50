#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace emax {

// Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"):
// a keyed bijection of a 128-bit counter, so any block of any stream is computed without a state.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

// The random numbers of one event: a pure function of (seed, index, purpose). The distributions are
// our own and use only additions, multiplications and comparisons: those of the standard library
// differ between implementations, and libm may differ in the last bit between machines.
class RandomStream {
 public:
  enum class Purpose : std::uint32_t {
    kAsk = 0,
    kTell = 1,
    kStart = 2,
    kDomain = 3,
    kTest = 4,
    kSobol = 5,
    kKnown = 6,
    kConsensus = 7
  };

  RandomStream(std::uint64_t seed, std::uint64_t index, Purpose purpose);

  std::uint64_t bits();
  double uniform();                            // multiples of 2^-53 in [0, 1)
  double uniform(double lower, double upper);  // in [lower, upper]
  std::uint64_t below(std::uint64_t count);    // 0 .. count-1 without bias; count > 0
  bool chance(double probability) { return uniform() < probability; }
  double gaussian();  // standard normal
  std::vector<std::size_t> permutation(std::size_t count);

 private:
  bool bernoulli_exp(double p);  // true with probability exp(-p), 0 <= p <= 1

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  unsigned used_ = 4;
};

}  // namespace emax
