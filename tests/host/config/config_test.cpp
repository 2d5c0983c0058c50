#include "host/config/config.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/genocop/genocop.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Real = ParameterKey<double>;
using Whole = ParameterKey<int>;

const Parameters& parameters() {
  static const Parameters all =
      parameters_of(Whole{"normals.k", 6, 40, 20, "neighbours of a normal"},
                    Real{"gp3.mu", 2, 6, 2.7, "search radius in nearest distances"},
                    Real{"gp3.min_angle", 0, 10, 5, "least angle in degrees"},
                    Real{"gp3.max_angle", 120, 175, 150, "greatest angle in degrees"},
                    Real{"decimate.reduction", 0, 0.98, 0.1, "share of triangles removed"},
                    Whole{"decimate.effort", 0, 3, 2, "how much", {}, false});
  return all;
}

class ConfigTest : public testing::Test {
 protected:
  ~ConfigTest() override { std::filesystem::remove(path_); }

  Config read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_config(path_, parameters());
  }

  // The message without the file's name, which must stand in front of it.
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find(path_.string() + ":"), 0u) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message.substr(path_.string().size() + 1);
    }
    ADD_FAILURE() << "accepted: " << text;
    return {};
  }

  const std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      (std::string("emax_config_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".toml");
};

TEST_F(ConfigTest, DefaultTextReadsBackExactly) {
  const std::string text = default_config_text(parameters());
  EXPECT_EQ(read(text), default_config(parameters()));
  for (const SettingInfo& info : setting_infos()) {
    EXPECT_NE(text.find('\n' + std::string(info.name) + " = "), std::string::npos) << info.name;
  }
  for (const Parameter& spec : parameters()) {
    EXPECT_NE(text.find(spec.meaning), std::string::npos) << spec.name;
  }
  EXPECT_FALSE(read("[search]\nbudget = 151") == default_config(parameters()));
}

TEST_F(ConfigTest, AnEmptyFileIsTheDefault) { EXPECT_EQ(read(""), default_config(parameters())); }

// Every setting can be changed by its name, and each changes what no other does; the text of all
// values tells any two apart.
TEST_F(ConfigTest, EverySettingIsRead) {
  std::vector<Config> seen = {default_config(parameters())};
  const auto changes = [&](const std::string& text) {
    const Config config = read(text);
    for (const Config& other : seen) {
      EXPECT_FALSE(config == other) << text;
      EXPECT_NE(named_values(config), named_values(other)) << text;
    }
    seen.push_back(config);
  };
  for (const SettingInfo& info : setting_infos()) {
    const std::string name(info.name);
    if (std::holds_alternative<bool Settings::*>(info.member)) {
      changes("[search]\n" + name + " = false");
    } else if (std::holds_alternative<RepairMethod Settings::*>(info.member)) {
      changes("[search]\n" + name + " = \"random\"");
      changes("[search]\n" + name + " = \"deterministic\"");
    } else if (std::holds_alternative<double Settings::*>(info.member)) {
      changes("[search]\n" + name + " = 0.321");
    } else {
      changes("[search]\n" + name + " = 37");
    }
  }
  for (const OperatorEntry& entry : kOperators) {
    changes("[search.operators]\n" + std::string(entry.name) + " = 2.5");
  }
  const std::string gene = "[genes.\"gp3.mu\"]\n";
  for (const char* of : {"lower = 2.5", "upper = 5", "standard = 3", "fixed = 2.7"})
    changes(gene + of);
  for (const char* of : {"lower = 1", "upper = 2", "fixed = 3"}) {
    changes("[genes.\"decimate.effort\"]\n" + std::string(of));
  }
  const std::string linear = "[[linear]]\nterms = { \"gp3.mu\" = ";
  for (const char* of : {"1 }\nat_most = 3", "1 }\nequals = 2.7", "1.5 }\nat_most = 5",
                         "1 }\nat_most = 3.5", "1, \"gp3.min_angle\" = 1 }\nat_most = 8"}) {
    changes(linear + of);
  }
}

TEST_F(ConfigTest, GenesAndConstraintsAreRead) {
  const Config config = read(R"(
[genes."normals.k"]
fixed = 12
[genes."gp3.mu"]
lower = 3
upper = 4.5
[[linear]]
terms = { "gp3.max_angle" = 1.0, "gp3.min_angle" = 2 }
at_most = 170
[[linear]]
terms = { "gp3.mu" = 1, "decimate.reduction" = 10 }
equals = 4
)");
  EXPECT_EQ(config.genes[0].fixed, 12);
  EXPECT_EQ(config.genes[1].lower, 3);
  EXPECT_EQ(config.genes[1].upper, 4.5);
  EXPECT_EQ(config.genes[1].standard, 3);  // moved into the narrowed domain
  using Relation = LinearConstraint::Relation;
  ASSERT_EQ(config.linear.size(), 2u);
  EXPECT_EQ(config.linear[0], (LinearConstraint{{{2, 2.0}, {3, 1.0}}, Relation::kAtMost, 170}));
  EXPECT_EQ(config.linear[1], (LinearConstraint{{{1, 1.0}, {4, 10.0}}, Relation::kEqual, 4}));

  const Problem problem = make_problem(config, "decimate.reduction");
  EXPECT_EQ(problem.monotone_gene, 4u);
  EXPECT_EQ(problem.genes[0].lower, 12);
  EXPECT_EQ(problem.genes[0].upper, 12);
  EXPECT_EQ(problem.starts, (std::vector<Genes>{{12, 3, 5, 150, 0.1, 2}}));
  Genocop search(problem, config.search, 1);
  EXPECT_EQ(search.ask().genes[0], 12);

  EXPECT_EQ(make_problem(config, "").monotone_gene, std::nullopt);
  EXPECT_EQ(make_problem(config, "normals.k").monotone_gene, std::nullopt);  // fixed
}

TEST_F(ConfigTest, WhatIsNotSearchedIsOnceItHasADomain) {
  const auto domain = [&](const std::string& text) {
    const Gene gene = make_problem(read(text), "").genes.back();
    return std::pair(gene.lower, gene.upper);
  };
  const std::string effort = "[genes.\"decimate.effort\"]\n";
  EXPECT_EQ(domain(""), std::pair(2.0, 2.0));
  EXPECT_EQ(domain(effort + "standard = 1"), std::pair(2.0, 2.0));
  EXPECT_EQ(domain(effort + "fixed = 1"), std::pair(1.0, 1.0));
  EXPECT_EQ(domain(effort + "lower = 1"), std::pair(1.0, 3.0));
  EXPECT_EQ(domain(effort + "upper = 2"), std::pair(0.0, 2.0));
  EXPECT_EQ(domain(effort + "fixed = 1\nlower = 0"), std::pair(1.0, 1.0));
}

TEST_F(ConfigTest, RefusesWithFileLineAndRemedy) {
  const auto expect = [&](const std::string& text, const std::string& start,
                          const std::string& part) {
    const std::string message = refusal(text);
    EXPECT_EQ(message.find(start), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect("\n[serach]\n", "2: unknown key \"serach\"", "search, genes, linear");
  expect("[search]\nbudgt = 3\n", "2: unknown key \"budgt\"", "budget");
  expect("[search]\nbudget = \"many\"\n", "2: budget", "number");
  expect("[search]\nbudget = 1.5\n", "2: budget", "whole");
  expect("[search]\nbudget = 0\n", "2: budget", "1 to");
  expect("[search]\nselection_pressure = nan\n", "2: selection_pressure", "finite");
  expect("[search]\nmonotone_step = 1\n", "2: monotone_step", "true or false");
  expect("[search]\nrepair = \"duct tape\"\n", "2: repair", "\"value-aware\"");
  expect("[search]\nrepair = 3\n", "2: repair", "\"value-aware\"");
  expect("search = 3\n", "1: search must be a table", "[search]");
  expect("[search.operators]\nmutation = 1\n", "2: unknown key \"mutation\"", "gaussian_mutation");
  expect("[search.operators]\ngaussian_mutation = -1\n", "2: gaussian_mutation", "0 to");
  expect("[genes.\"gp3.nu\"]\nlower = 1\n", "1: unknown gene \"gp3.nu\"", "gp3.mu");
  expect("[genes.\"gp3.mu\"]\nlowest = 1\n", "2: unknown key \"lowest\"", "lower");
  expect("[genes.\"gp3.mu\"]\n\nlower = 1\n", "3: genes.\"gp3.mu\".lower = 1", "2 to 6");
  expect("[genes.\"gp3.mu\"]\nlower = 5\nupper = 3\n", "1: genes.\"gp3.mu\"", "exchange");
  expect("[genes.\"gp3.mu\"]\nlower = 3\nstandard = 2.5\n", "1: genes.\"gp3.mu\"", "move it");
  expect("[genes.\"gp3.mu\"]\nfixed = 7\n", "2: genes.\"gp3.mu\".fixed", "2 to 6");
  expect("[genes.\"normals.k\"]\nupper = 30.5\n", "2: genes.\"normals.k\".upper", "whole");
  expect("[genes]\n\"gp3.mu\" = 3\n", "2: genes.\"gp3.mu\" must be a table", "write");
  expect("[linear]\nat_most = 3\n", "1: linear", "[[linear]]");
  expect("[[linear]]\nat_most = 3\n", "1: [[linear]] needs terms", "at_most");
  expect("[[linear]]\nterms = { \"gp3.mu\" = 1 }\n", "1: [[linear]] needs", "at_most");
  expect("[[linear]]\nterms = { \"gp3.nu\" = 1 }\nat_most = 3\n", "2: unknown gene", "gp3.mu");
  expect("[[linear]]\nterms = { \"gp3.mu\" = 1 }\nat_most = 2.5\n", "1: the standard values",
         "2.7");
  expect("[[linear]]\nterms = { \"gp3.mu\" = 1 }\nequals = 2.5\n", "1: the standard", "exactly");
  expect("[search\n", "1: ", "TOML");
  expect("[search]\nbudget = 1\nbudget = 2\n", "3: ", "TOML");
}

TEST_F(ConfigTest, RefusesWhatCannotBeRead) {
  EXPECT_THROW(read_config(path_, parameters()), Error);
  EXPECT_THROW(read_config(std::filesystem::temp_directory_path(), parameters()), Error);
}

// Methods as categories, each with parameters of its own.
TEST(Config, CategoriesBecomeGenesWithTheirStarts) {
  enum class Method { kGp3, kPoisson, kHoppe };
  enum class Holes { kNone, kAll };
  constexpr std::array<std::string_view, 3> kMethods = {"gp3", "poisson", "hoppe"};
  constexpr std::array<std::string_view, 2> kHoles = {"none", "all"};
  Parameters specs = parameters_of(
      ParameterKey<Method>{"method", Method::kGp3, Method::kHoppe, Method::kPoisson, "how",
                           kMethods},
      Real{"mu", 2, 6, 3, "search radius"},
      ParameterKey<Holes>{"fill", Holes::kNone, Holes::kAll, Holes::kNone, "holes", kHoles},
      Real{"size", 0, 1, 0.5, "of holes"});
  specs[1].only_with = {0, 0};
  specs[3].only_with = {2, 0, true};
  const std::string text = default_config_text(specs);
  EXPECT_NE(text.find("0: gp3, 1: poisson, 2: hoppe"), std::string::npos) << text;
  EXPECT_NE(text.find("only with method = 0"), std::string::npos) << text;
  EXPECT_NE(text.find("only without fill = 0"), std::string::npos) << text;
  Config config = default_config(specs);
  const Problem problem = make_problem(config, "");
  EXPECT_EQ(problem.genes[0].kind, Gene::Kind::kCategorical);
  EXPECT_EQ(problem.genes[1].only_with, (Gene::Condition{0, 0}));
  EXPECT_EQ(problem.genes[3].only_with, (Gene::Condition{2, 0, true}));
  EXPECT_EQ(problem.starts,
            (std::vector<Genes>{{1, 3, 0, 0.5}, {0, 3, 0, 0.5}, {2, 3, 0, 0.5}, {1, 3, 1, 0.5}}));
  config.genes[0].fixed = 2;
  const Problem narrowed = make_problem(config, "");
  EXPECT_EQ(narrowed.starts, (std::vector<Genes>{{2, 3, 0, 0.5}, {2, 3, 1, 0.5}}));
  EXPECT_EQ(Genocop(narrowed, {}, 1).ask().genes, narrowed.starts[0]);
}

}  // namespace
}  // namespace emax
