// Runs the co-simulation's tests on the builds that count coverage, and reports it by module.
//
//   emax_coverage [--seed N] [--folder FOLDER] [--missed]
//
// Writes Verilator's counts and tests.txt, with the share that each test reaches, to the folder
// (default build/coverage). --missed names the points that were never hit. Exit code 1 below 98 %
// in lines, branches or toggles over all modules, or where a test fails.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "testbench/cosimulation/coverage_report.h"
#include "testbench/cosimulation/suite.h"
#include "testbench/element/verilated_variants.h"

namespace emax {
namespace {

constexpr double kEnough = 98;
// Fewer than in a test without counting, which is a hundred times as fast; points are reached
// early.
constexpr std::uint64_t kOperatorPairs = 200'000, kPart = 10;

struct Options {
  std::string folder = "build/coverage";
  std::uint64_t seed = 1;
  bool missed = false;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--missed") {
      options.missed = true;
    } else if (argument == "--seed" && i + 1 < argc) {
      options.seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--folder" && i + 1 < argc) {
      options.folder = argv[++i];
    } else {
      return false;
    }
  }
  return true;
}

int run(const Options& options) {
  std::filesystem::create_directories(options.folder);
  const std::string operators = options.folder + "/operators.dat";
  const OperatorTest counted{
      binary32_test(make_covered_operators, kOperatorPairs).name, make_covered_operators,
      [&](OperatorUnit& unit, std::uint64_t seed, const OperatorWatch& watch) {
        OperatorRun run = run_operator_cosim(unit, kOperatorPairs, seed, false, watch);
        unit.write_coverage(operators);
        return run;
      }};
  Suite suite;
  suite.operators = {counted};
  suite.make_element = make_covered_element;
  suite.options.seed = options.seed;
  suite.options.part = kPart;
  std::vector<std::string> files;
  std::map<std::string, double> shares;
  suite.finish = [&](TestReport& report) {
    if (files.empty()) {
      files.push_back(operators);
    } else {
      files.push_back(options.folder + "/element" + std::to_string(files.size()) + ".dat");
      write_coverage(files.back());
    }
    report.coverage = shares[report.name] = percent_of_all(read_coverage({files.back()}));
  };
  const SuiteResult result = run_suite(suite);
  write_test_coverage(shares, options.folder + "/tests.txt");

  const CoverageReport report = read_coverage(files);
  std::printf("\n");
  print_coverage(report, options.missed);
  std::printf("coverage: lines %.2f %%, branches %.2f %%, toggles %.2f %%\n",
              percent(report.all[0]), percent(report.all[1]), percent(report.all[2]));
  bool enough = true;
  for (const CoverageCount& count : report.all) enough = enough && percent(count) >= kEnough;
  return result.mismatches == 0 && enough ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::Options options;
  if (!emax::parse(argc, argv, options)) {
    std::fprintf(stderr, "usage: emax_coverage [--seed N] [--folder FOLDER] [--missed]\n");
    return 2;
  }
  try {
    return emax::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_coverage: %s\n", error.what());
    return 2;
  }
}
