#include "host/app/run_identity.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <set>

#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

// What is asked of a search.
struct Asked {
  OptimizeOptions options;
  OptimizeSettings settings;
  std::string cloud_sha256 = "of a scan";
  double epsilon = 0.5;

  Asked() {
    settings.config = default_config(chain_parameters(settings.method, settings.decimator));
    settings.epsilon_back = epsilon;
    settings.output = "mesh.ply";
  }
  RunSettings identity() const { return run_settings(options, settings, cloud_sha256, epsilon); }
};

// The names whose values differ, or that one of the two lacks.
std::set<std::string> differences(const RunSettings& a, const RunSettings& b) {
  std::set<std::string> names;
  const std::set all_a(a.begin(), a.end()), all_b(b.begin(), b.end());
  for (const auto& entry : a) {
    if (!all_b.contains(entry)) names.insert(entry.first);
  }
  for (const auto& entry : b) {
    if (!all_a.contains(entry)) names.insert(entry.first);
  }
  return names;
}

using Change = std::function<void(Asked&)>;

std::set<std::string> changed_by(const Change& change) {
  Asked changed;
  change(changed);
  return differences(Asked().identity(), changed.identity());
}

TEST(RunIdentity, IsAnotherWhereAResultWouldBe) {
  const std::vector<std::pair<std::string, Change>> changes = {
      {"cloud.sha256", [](Asked& a) { a.cloud_sha256 = "of another"; }},
      {"cloud.skip_invalid", [](Asked& a) { a.options.common.reading.skip_invalid = true; }},
      {"max_error", [](Asked& a) { a.epsilon = std::nextafter(a.epsilon, 1); }},
      {"exclude_outliers", [](Asked& a) { a.options.common.excluded_share = "1%"; }},
      {"method", [](Asked& a) { a.settings.method = "imls"; }},
      {"decimator", [](Asked& a) { a.settings.decimator = "auto"; }},
      {"bound", [](Asked& a) { a.settings.epsilon_back.reset(); }},
      {"closed", [](Asked& a) { a.settings.closed = true; }},
      {"features", [](Asked& a) { a.settings.features = kAutoFeatures; }},
      {"hole_reach", [](Asked& a) { a.settings.hole_reach = 0; }},
      {"mesh.ending", [](Asked& a) { a.settings.output = "mesh.stl"; }},
      {"seed", [](Asked& a) { a.settings.seed = 2; }},
      {"search.look_ahead", [](Asked& a) { a.settings.config.search.look_ahead = 8; }},
      {"search.operators.gaussian_mutation",
       [](Asked& a) { a.settings.config.search.frequency_of(gaussian_mutation) = 3; }},
      {"genes.gp3.mu",
       [](Asked& a) {
         for (Parameter& gene : a.settings.config.genes) {
           if (gene.name == Gp3::kMu.name) gene.fixed = 3;
         }
       }},
      {"linear.0",
       [](Asked& a) {
         a.settings.config.linear = {{{{0, 1.0}}, LinearConstraint::Relation::kAtMost, 30}};
       }},
  };
  for (const auto& [name, change] : changes) {
    EXPECT_EQ(changed_by(change), std::set{name});
  }
}

// Workers, device and what ends a run leave the bytes of its results as they are.
TEST(RunIdentity, IsTheSameWhereResultsAre) {
  const std::vector<std::pair<const char*, Change>> changes = {
      {"jobs", [](Asked& a) { a.settings.jobs = 7; }},
      {"device", [](Asked& a) { a.options.common.device = "sim"; }},
      {"brute force", [](Asked& a) { a.options.common.brute_force = true; }},
      {"name of the mesh", [](Asked& a) { a.settings.output = "other.ply"; }},
      {"share as text", [](Asked& a) { a.options.common.excluded_share = "0%"; }},
      {"budget", [](Asked& a) { a.settings.config.search.budget += 100; }},
      {"target", [](Asked& a) { a.settings.target_triangles = 100; }},
      {"stagnation", [](Asked& a) { a.settings.stagnation = 5; }},
      {"time", [](Asked& a) { a.settings.seconds_left = [] { return 1.0; }; }},
      {"polish", [](Asked& a) { a.settings.polish = false; }},
      {"limits", [](Asked& a) { a.settings.limits = standard_limits(1'000'000); }},
      {"fitted values", [](Asked& a) { a.settings.fitted.set(Gp3::kMu, 3); }},
  };
  for (const auto& [name, change] : changes) {
    EXPECT_EQ(changed_by(change), std::set<std::string>{}) << name;
  }
}

TEST(RunIdentity, LeavesTheBoundOpenWhereTheDecimatorKnowsOne) {
  const auto open = [](const Asked& asked) {
    std::vector<std::string> names;
    for (const auto& [name, value] : asked.identity()) {
      if (value.empty()) names.push_back(name);
    }
    return names;
  };
  Asked asked;
  EXPECT_EQ(open(asked), std::vector<std::string>{kBoundSetting});
  asked.settings.decimator = "schroeder";
  EXPECT_EQ(open(asked), std::vector<std::string>{});
}

TEST(RunIdentity, NamesEverySettingOnce) {
  std::set<std::string> names;
  for (const auto& [name, value] : Asked().identity()) {
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  for (const char* name : {"emax", "kernel", "libraries", "processor", "build"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(ChecksumOfTheBound, IsThatOfReferenceAndOutliers) {
  const Stimulus sphere = bumpy_sphere(8, 12, 10, 1);
  const DecimationBound bound = {1, 1, {sphere.vertices, sphere.triangles}, {1, 23}};
  EXPECT_EQ(checksum(bound), checksum(bound));
  DecimationBound moved = bound;
  moved.reference.vertices[0].x() = std::nextafter(moved.reference.vertices[0].x(), 2);
  DecimationBound turned = bound;
  Triangle& first = turned.reference.triangles[0];
  first = {first[1], first[2], first[0]};
  DecimationBound fewer = bound;
  fewer.outliers = {1};
  DecimationBound others = bound;
  others.outliers = {12, 3};
  const std::set<std::string> sums = {checksum(bound), checksum(moved), checksum(turned),
                                      checksum(fewer), checksum(others)};
  EXPECT_EQ(sums.size(), 5u);
}

TEST(DescribeRun, SaysWhatIsThere) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "run";
  const RunSettings settings = {{"of", "the test"}};
  {
    RunLog log(path, settings);
    EXPECT_EQ(describe(log, 20), "starts in " + path.string());
    for (const std::uint64_t index : {0, 1, 2, 30}) {
      LoggedEvaluation evaluation;
      evaluation.index = index;
      evaluation.genes = {1};
      log.append(evaluation);
    }
  }
  const std::string continues = "continues in " + path.string() + ": ";
  EXPECT_EQ(describe(RunLog(path, settings), 20), continues + "3 of 20 evaluations are there");
  EXPECT_EQ(describe(RunLog(path, settings), 40), continues + "4 of 40 evaluations are there");
  std::ofstream(path / "evaluations.log", std::ios::app | std::ios::binary) << "torn";
  EXPECT_EQ(describe(RunLog(path, settings), 40),
            continues + "4 of 40 evaluations are there; 4 bytes of a torn record were cut off");
}

}  // namespace
}  // namespace emax::test
