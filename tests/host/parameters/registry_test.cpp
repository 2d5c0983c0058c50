// A method and a decimator that the product lacks. All that registers them is in this file: their
// structs, and the tables of the registry with their names added, which the linker takes in place
// of the product's.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "host/app/command_line.h"
#include "host/chain/chain.h"
#include "host/chain/decimator_run.h"
#include "host/config/config.h"
#include "host/parameters/descriptions.h"
#include "host/reconstruct/reconstruction.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/support/messages.h"

namespace emax {
namespace test {
namespace {

// The same tetrahedron whatever the cloud is.
struct Tetrahedron : MethodDefaults {
  static constexpr std::string_view kName = "tetrahedron";
  static constexpr std::string_view kRemedy = "raise tetrahedron.size";
  static constexpr ParameterKey<double> kSize{"tetrahedron.size", 0, 9, 3, "length of its legs"};

  static Parameters parameters() { return parameters_of(kSize); }
  static Reconstruction run(const LocalCloud&, const ParameterValues& values, std::size_t) {
    const double a = values.at(kSize);
    return {{{{0, 0, 0}, {a, 0, 0}, {0, a, 0}, {0, 0, a}},
             {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}},
            0};
  }
};

struct FirstTriangles {
  static constexpr std::string_view kName = "first";
  static constexpr std::string_view kMeaning = "the first triangles are left";
  static constexpr bool kBounded = false;
  static constexpr std::string_view kMonotone = {};
  static constexpr ParameterKey<int> kLeft{"first.left", 1, 4, 2, "how many triangles are left"};

  static Parameters parameters() { return parameters_of(kLeft); }
  static TriangleMesh run(const TriangleMesh& mesh, const ParameterValues& values) {
    TriangleMesh left = mesh;
    left.triangles.resize(static_cast<std::size_t>(values.at(kLeft)));
    return left;
  }
};

template <typename More, typename... T>
TypeList<T..., More> with(TypeList<T...>) {
  return {};
}
using Methods = decltype(with<Tetrahedron>(ReconstructionMethods{}));
using AllDecimators = decltype(with<FirstTriangles>(Decimators{}));

}  // namespace
}  // namespace test

std::span<const MethodDescription> reconstruction_methods() {
  static const auto all = descriptions_of(test::Methods{});
  return all;
}
std::span<const DecimatorDescription> decimators() {
  static const auto all = decimator_descriptions_of(test::AllDecimators{});
  return all;
}
std::span<const MethodRun> method_runs() {
  static const auto all = runs_of(test::Methods{});
  return all;
}
std::span<const DecimatorRun> decimator_runs() {
  static const auto all = decimator_runs_of(test::AllDecimators{});
  return all;
}

namespace test {
namespace {

class RegistryTest : public testing::Test {
 protected:
  RegistryTest() { add_commands(app_, line_); }

  // Without its line breaks.
  std::string help(const char* command) const {
    std::string text = app_.get_subcommand(command)->help();
    std::string words;
    for (const char c : text) {
      const bool blank = c == ' ' || c == '\n';
      if (!blank || (!words.empty() && words.back() != ' ')) words += blank ? ' ' : c;
    }
    return words;
  }
  std::string refusal(const std::string& words) {
    try {
      app_.parse(words);
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "none";
  }

  CLI::App app_;
  CommandLine line_;
};

void expect_within(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in " << text;
}

TEST_F(RegistryTest, OptionsTakeItAndTheHelpNamesIt) {
  for (const char* command : {"optimize", "config"}) {
    expect_within(help(command), "{fit,gp3,poisson,hoppe,imls,shapes,tetrahedron,auto}");
    expect_within(help(command), "{bounded,schroeder,first,auto}");
    expect_within(help(command), "; first: the first triangles are left; auto: ");
  }
  expect_within(help("optimize"), "but one-sided with --decimator schroeder, first or auto)");
  EXPECT_EQ(refusal("config --method tetrahedron --decimator first"), "none");
  EXPECT_EQ(line_.config_method, "tetrahedron");
  EXPECT_EQ(line_.config_decimator, "first");
  expect_within(refusal("config --method alpha"), "imls,shapes,tetrahedron,auto");
  expect_within(refusal("config --decimator alpha"), "schroeder,first,auto");
}

TEST(Registry, ErrorTextsNameIt) {
  EXPECT_EQ(message_of([] { method_named("alpha"); }),
            "there is no reconstruction method 'alpha'; choose gp3, poisson, hoppe, imls, shapes, "
            "tetrahedron or auto");
  EXPECT_EQ(message_of([] { decimator_named("quadric"); }),
            "there is no decimator 'quadric'; choose bounded, schroeder or first");
  ParameterValues flat(chain_parameters("tetrahedron", kNoDecimator));
  flat.set(Tetrahedron::kSize, 0);
  expect_within(message_of([&] { reconstruct("tetrahedron", sphere_cloud(50), flat); }),
                "raise tetrahedron.size");
}

TEST(Registry, TheConfigurationAndTheGenesHoldIt) {
  const Parameters own = chain_parameters("tetrahedron", "first");
  const std::string text = default_config_text(own);
  expect_within(text, "# length of its legs (number)\n[genes.\"tetrahedron.size\"]\nlower = 0\n");
  expect_within(text, "[genes.\"first.left\"]\n");
  const Problem problem = make_problem(default_config(own), "");
  ASSERT_EQ(problem.genes.size(), 3u);
  EXPECT_EQ(problem.genes[0].name, "tetrahedron.size");
  EXPECT_EQ(problem.genes[0].upper, 9);
  EXPECT_EQ(problem.starts[0], (Genes{3, 0.2, 2}));

  const Parameters all = chain_parameters(kAutoMethod, kAutoDecimator);
  expect_within(default_config_text(all), "4: tetrahedron)");
  expect_within(default_config_text(all), "2: first)");
  expect_within(default_config_text(all), "(number; only with method = 4)");
  const auto size = std::ranges::find(all, Tetrahedron::kSize.name, &Parameter::name);
  ASSERT_NE(size, all.end());
  EXPECT_EQ(size->only_with, (Gene::Condition{0, 4}));
}

TEST(Registry, TheChainRunsIt) {
  Chain chain(sphere_cloud(50));
  ChainSettings candidate{"tetrahedron", kNoDecimator,
                          ParameterValues(chain_parameters("tetrahedron", kNoDecimator))};
  candidate.parameters.set(Tetrahedron::kSize, 5);
  const TriangleMesh whole = chain.run(candidate).mesh;
  EXPECT_EQ(whole.triangles.size(), 4u);
  EXPECT_EQ(std::ranges::count(whole.vertices, Point(5, 0, 0)), 1);

  // As the search chooses it.
  ParameterValues values(chain_parameters(kAutoMethod, kAutoDecimator));
  values.by_name()["method"] = 4;
  values.by_name()["decimator"] = 2;
  const ChainSettings chosen = chain_settings(kAutoMethod, kAutoDecimator, values);
  EXPECT_EQ(chosen.method, "tetrahedron");
  EXPECT_EQ(chosen.decimator, "first");
  EXPECT_TRUE(chosen.parameters.contains(Tetrahedron::kSize));
  EXPECT_FALSE(chosen.parameters.contains(Gp3::kMu));
  EXPECT_EQ(chain.run(chosen).mesh.triangles.size(), 2u);
}

}  // namespace
}  // namespace test
}  // namespace emax
