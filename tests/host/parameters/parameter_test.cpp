#include "host/parameters/parameter.h"

#include <gtest/gtest.h>

#include <set>

#include "host/parameters/chain_parameters.h"
#include "host/parameters/descriptions.h"
#include "sw_model/base/error.h"
#include "tests/support/messages.h"

namespace emax::test {
namespace {

template <typename Key>
concept IsKey = requires(const ParameterValues& values, Key key) {
  values.at(key);
};
static_assert(IsKey<ParameterKey<double>> && IsKey<ParameterKey<Fill::Method>>);
static_assert(!IsKey<const char*> && !IsKey<std::string> && !IsKey<std::string_view>,
              "a mistyped name must not compile");

template <typename Method>
concept HasMu = requires {
  Method::kMu;
};
static_assert(HasMu<Gp3> && !HasMu<Poisson>, "nor must the key of another method");

template <typename T, typename Value>
concept Takes = requires(ParameterValues values, ParameterKey<T> key, Value value) {
  values.set(key, value);
};
static_assert(Takes<Fill::Method, Fill::Method> && Takes<double, double>);
static_assert(!Takes<Fill::Method, int> && !Takes<Fill::Method, Mls::Method> &&
                  !Takes<int, Fill::Method>,
              "nor a value of another type");

TEST(ParameterKey, GivesTheKindOfItsType) {
  using Kind = Gene::Kind;
  EXPECT_EQ(Gp3::kMu.parameter().kind, Kind::kContinuous);
  EXPECT_EQ(Gp3::kMaxNeighbors.parameter().kind, Kind::kInteger);
  EXPECT_EQ(Schroeder::kSplitting.parameter().kind, Kind::kInteger);
  const Parameter fill = Fill::kMethod.parameter();
  EXPECT_EQ(fill.kind, Kind::kCategorical);
  EXPECT_EQ(fill.upper, 2);
  EXPECT_EQ(fill.standard, 1);
  EXPECT_EQ(fill.categories.size(), 3u);
}

TEST(ParameterKey, IsFixedWhereASearchGainsNothing) {
  EXPECT_EQ(Bounded::kEffort.parameter().fixed, 2);
  EXPECT_EQ(Bounded::kFlatness.parameter().fixed, std::nullopt);
}

TEST(ParameterKey, MayHaveAnotherStandard) {
  constexpr ParameterKey<int> kOther = Normals::kNeighbours.with_standard(15);
  EXPECT_EQ(kOther.parameter().standard, 15);
  EXPECT_EQ(kOther.name, Normals::kNeighbours.name);
  EXPECT_NE(Normals::kNeighbours.standard, 15);
}

TEST(ParameterValues, KeepWhatIsSet) {
  ParameterValues values(Schroeder::parameters());
  EXPECT_TRUE(values.at(Schroeder::kAccumulateError));
  EXPECT_FALSE(values.at(Schroeder::kSplitting));
  values.set(Schroeder::kSplitting, true);
  values.set(Fill::kMethod, Fill::Method::kSmooth);
  EXPECT_TRUE(values.at(Schroeder::kSplitting));
  EXPECT_EQ(values.at(Fill::kMethod), Fill::Method::kSmooth);
  EXPECT_EQ(values.by_name().at("fill.method"), 2);
  EXPECT_EQ(values.find(Gp3::kMu), std::nullopt);
  values.set(Gp3::kMu, 2.5);
  EXPECT_EQ(values.find(Gp3::kMu), 2.5);
}

TEST(ParameterValues, NameTheOneThatIsMissing) {
  ParameterValues values(Gp3::parameters());
  EXPECT_NO_THROW(values.require(Gp3::parameters()));
  values.by_name().erase("gp3.mu");
  const std::string missing = "the parameter gp3.mu has no value";
  EXPECT_EQ(message_of([&] { values.require(Gp3::parameters()); }), missing);
  EXPECT_EQ(message_of([&] { (void)values.at(Gp3::kMu); }), missing);
}

// In every chain a condition names a categorical gene of the same list.
TEST(ChainParameters, HoldConditionsOfTheirOwnList) {
  std::vector<std::string> methods = names_of(reconstruction_methods());
  methods.insert(methods.end(), {kFitMethod, kAutoMethod});
  std::vector<std::string> chosen = names_of(decimators());
  chosen.insert(chosen.end(), {kNoDecimator, kAutoDecimator});
  std::set<std::string> conditions;
  for (const std::string& method : methods) {
    for (const std::string& decimator : chosen) {
      const Parameters chain = chain_parameters(method, decimator);
      for (const Parameter& p : chain) {
        if (!p.only_with) continue;
        ASSERT_LT(p.only_with->gene, chain.size()) << p.name;
        const Parameter& other = chain[p.only_with->gene];
        EXPECT_EQ(other.kind, Gene::Kind::kCategorical) << p.name;
        EXPECT_FALSE(other.only_with) << p.name;
        conditions.insert(p.name + (p.only_with->unless ? " without " : " with ") + other.name);
      }
    }
  }
  for (const char* condition :
       {"gp3.mu with method", "hoppe.reach with method", "mls.radius without mls.method",
        "mls.cell with mls.method", "fill.size without fill.method",
        "bounded.flatness with decimator", "schroeder.reduction with decimator"}) {
    EXPECT_TRUE(conditions.contains(condition)) << condition;
  }
  EXPECT_FALSE(conditions.contains("normals.k with method"));
}

TEST(Decimators, SayWhetherTheyKeepABound) {
  const auto answers = [](const char* decimator) {
    return std::pair(takes_bound(decimator), keeps_bound(decimator));
  };
  EXPECT_EQ(answers("bounded"), std::pair(true, true));
  EXPECT_EQ(answers("schroeder"), std::pair(false, false));
  EXPECT_EQ(answers(kAutoDecimator), std::pair(true, false));
  EXPECT_EQ(answers(kNoDecimator), std::pair(true, false));
  EXPECT_THROW(takes_bound("quadric"), Error);
  EXPECT_THROW(keeps_bound("quadric"), Error);
}

}  // namespace
}  // namespace emax::test
