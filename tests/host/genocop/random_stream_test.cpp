#include "host/genocop/random_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace emax {
namespace {

using Purpose = RandomStream::Purpose;
using Block = std::array<std::uint32_t, 4>;

// The known answers of the authors' Random123 package.
TEST(Philox, AgreesWithPublishedVectors) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, EveryArgumentSelectsAnotherStream) {
  const auto first = [](std::uint64_t seed, std::uint64_t index, Purpose purpose) {
    return RandomStream(seed, index, purpose).bits();
  };
  const std::set<std::uint64_t> values = {
      first(1, 1, Purpose::kAsk),          first(2, 1, Purpose::kAsk),
      first(1, 2, Purpose::kAsk),          first(1, 1, Purpose::kTell),
      first(1ull << 32, 1, Purpose::kAsk), first(1, 1ull << 32, Purpose::kAsk)};
  EXPECT_EQ(values.size(), 6u);
  EXPECT_EQ(first(1, 1, Purpose::kAsk), first(1, 1, Purpose::kAsk));
}

TEST(RandomStream, BelowIsUniformAndNeverOutside) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  RandomStream random(kSeed, 0, Purpose::kTest);
  constexpr int kDraws = 60000;
  std::array<int, 6> counts{};
  for (int i = 0; i < kDraws; ++i) {
    const std::uint64_t value = random.below(6);
    ASSERT_LT(value, 6u);
    ++counts[value];
  }
  double chi_squared = 0;
  for (int count : counts) chi_squared += std::pow(count - kDraws / 6.0, 2) / (kDraws / 6.0);
  EXPECT_LT(chi_squared, 20.5);  // 5 degrees of freedom, 0.999
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.below(1), 0u);
}

// A count just above 2^63 rejects almost half of the raw values: a plain remainder would make the
// lower part twice as frequent.
TEST(RandomStream, BelowHasNoRemainderBias) {
  constexpr std::uint64_t kSeed = 6;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  constexpr std::uint64_t kCount = 3ull << 62;
  constexpr int kDraws = 30000;
  const auto low_third = [&](auto draw) {
    RandomStream random(kSeed, 0, Purpose::kTest);
    int low = 0;
    for (int i = 0; i < kDraws; ++i) low += draw(random) < kCount / 3;
    return std::abs(static_cast<double>(low) / kDraws - 1.0 / 3);
  };
  EXPECT_LT(low_third([](RandomStream& r) { return r.below(kCount); }), 0.01);
  EXPECT_GT(low_third([](RandomStream& r) { return r.bits() % kCount; }), 0.1);  // the fault
}

double kolmogorov_distance(std::vector<double> sample, double (*distribution)(double)) {
  std::sort(sample.begin(), sample.end());
  double distance = 0;
  const auto n = static_cast<double>(sample.size());
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double expected = distribution(sample[i]);
    distance = std::max({distance, std::abs(expected - static_cast<double>(i) / n),
                         std::abs(expected - static_cast<double>(i + 1) / n)});
  }
  return distance;
}

TEST(RandomStream, UniformAndGaussianFollowTheirDistributions) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  constexpr int kDraws = 50000;
  const double limit = 1.95 / std::sqrt(double{kDraws});  // Kolmogorov-Smirnov, 0.999
  RandomStream random(kSeed, 0, Purpose::kTest);
  std::vector<double> uniform(kDraws), gaussian(kDraws);
  for (double& u : uniform) u = random.uniform();
  for (double& g : gaussian) g = random.gaussian();
  EXPECT_GE(*std::min_element(uniform.begin(), uniform.end()), 0.0);
  EXPECT_LT(*std::max_element(uniform.begin(), uniform.end()), 1.0);
  const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  EXPECT_LT(kolmogorov_distance(uniform, [](double x) { return x; }), limit);
  EXPECT_LT(kolmogorov_distance(gaussian, normal), limit);
  EXPECT_GT(kolmogorov_distance(uniform, normal), limit);  // the measure can fail
}

TEST(RandomStream, PermutationHoldsEveryIndexOnce) {
  RandomStream random(8, 0, Purpose::kTest);
  std::vector<std::size_t> order = random.permutation(20);
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

}  // namespace
}  // namespace emax
