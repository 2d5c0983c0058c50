#include <gtest/gtest.h>

#include <algorithm>

#include "Vbehavioural_multipliers_rtl.h"
#include "Vecp5_multipliers_rtl.h"
#include "Vecp5_multipliers_rtl___024root.h"
#include "Vecp5_multipliers_rtl_emax_mutation.h"
#include "Vxilinx_multipliers_rtl.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr int kProductsSettled = 12;  // cycles after which all that comes out was put in
constexpr unsigned kAllLatencies = (1u << 7) - 1;

struct ProductDifferences {
  unsigned product = 0, square = 0, narrow_product = 0, narrow_square = 0;
  bool any() const { return (product | square | narrow_product | narrow_square) != 0; }
};

std::vector<std::pair<std::uint32_t, std::uint32_t>> operands() {
  // Ends of the operands and of the parts at bits 17, 18 and 20 that the families cut them into.
  std::vector<std::uint32_t> corners = {0, 1, 2, 0xffffff, 0xfffffe, 0x800000, 0x7fffff, 0xaaaaaa};
  for (const int cut : {11, 17, 18, 20}) {
    const std::uint32_t place = 1u << cut;
    corners.insert(corners.end(), {place, place - 1, place + 1, 0xffffffu & ~(place - 1)});
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const std::uint32_t a : corners)
    for (const std::uint32_t b : corners) pairs.emplace_back(a, b);
  Random random(named_seed("mapped multipliers", 1));
  for (int i = 0; i < 100'000; ++i)
    pairs.emplace_back(random.below(1 << 24), random.below(1 << 24));
  return pairs;
}

template <class Model>
ProductDifferences run(Model& rtl, bool fault = false) {
  ProductDifferences differences;
  rtl.fault = fault;
  int cycle = 0;
  for (const auto& [a, b] : operands()) {
    rtl.a = a;
    rtl.b = b;
    rtl.clk = 0;
    rtl.eval();
    rtl.clk = 1;
    rtl.eval();
    if (++cycle < kProductsSettled) continue;
    differences.product |= rtl.product_differs;
    differences.square |= rtl.square_differs;
    differences.narrow_product |= rtl.narrow_product_differs;
    differences.narrow_square |= rtl.narrow_square_differs;
  }
  return differences;
}

template <class Model>
void expect_products() {
  VerilatedContext context;
  Model rtl(&context);
  const ProductDifferences differences = run(rtl);
  EXPECT_EQ(differences.product, 0u) << "bit LATENCY - 3";
  EXPECT_EQ(differences.square, 0u) << "bit LATENCY - 3";
  EXPECT_EQ(differences.narrow_product, 0u) << "bit LATENCY - 3";
  EXPECT_EQ(differences.narrow_square, 0u) << "bit LATENCY - 3";
}

TEST(MantissaMultiply, BehaviouralGivesProductsAtEveryLatency) {
  expect_products<Vbehavioural_multipliers_rtl>();
}

TEST(MantissaMultiply, Ecp5GivesProductsAtEveryLatency) {
  expect_products<Vecp5_multipliers_rtl>();
}

TEST(MantissaMultiply, XilinxGivesProductsAtEveryLatency) {
  expect_products<Vxilinx_multipliers_rtl>();
}

TEST(MantissaMultiply, FaultIsSeenAtEveryLatency) {
  VerilatedContext context;
  Vecp5_multipliers_rtl rtl(&context);
  const ProductDifferences differences = run(rtl, true);
  EXPECT_EQ(differences.product, kAllLatencies);
  EXPECT_EQ(differences.square, kAllLatencies);
  EXPECT_EQ(differences.narrow_product, kAllLatencies);
  EXPECT_EQ(differences.narrow_square, kAllLatencies);
}

TEST(MantissaMultiply, EveryMutantOfEcp5IsCaught) {
  int tried = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.module.starts_with("ecp5/")) continue;
    ++tried;
    VerilatedContext context;
    Vecp5_multipliers_rtl rtl(&context);
    rtl.eval();  // its initial blocks make the design unchanged
    rtl.rootp->__PVT__emax_mutation->active = static_cast<IData>(mutant.number);
    EXPECT_TRUE(run(rtl).any()) << mutant.name << ": " << mutant.fault;
  }
  EXPECT_EQ(tried, 3);
}

}  // namespace
}  // namespace emax
