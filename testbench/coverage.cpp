// Runs the element's tests on the build that counts coverage, and reports it by module.
//
//   emax_coverage [--seed N] [--full] [--coverage FILE] [--merge FILE]... [--report] [--missed]
//
// --coverage keeps the counts (default coverage.dat); --merge adds those of other programs,
// --report runs nothing and only reports, --missed names what was never hit. Exit code 1 below 98 %
// in lines, branches or toggles over all modules, or where a test fails.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "testbench/cosimulation.h"
#include "testbench/coverage_report.h"
#include "testbench/table.h"
#include "testbench/verilated_variants.h"

namespace emax {
namespace {

constexpr double kEnough = 98;

struct Options {
  std::string file = "coverage.dat";
  std::vector<std::string> merged;
  bool report_only = false, missed = false;
  CosimulationOptions settings;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool has_value = i + 1 < argc;
    if (argument == "--report") {
      options.report_only = true;
    } else if (argument == "--missed") {
      options.missed = true;
    } else if (argument == "--full") {
      options.settings.full = true;
    } else if (argument == "--seed" && has_value) {
      options.settings.seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--coverage" && has_value) {
      options.file = argv[++i];
    } else if (argument == "--merge" && has_value) {
      options.merged.emplace_back(argv[++i]);
    } else {
      return false;
    }
  }
  return true;
}

int run(Options options) {
  bool passed = true;
  if (!options.report_only) {
    Table table;
    table.print_head();
    for (const ElementTest& test : element_tests()) {
      options.settings.progress = [&](double share) { table.show_progress(test.name, share); };
      const TestReport report = run_test(test, make_covered_element, options.settings);
      table.print_row(report);
      passed = passed && !report.failure;
    }
    table.print_sum();
    write_coverage(options.file);
  }
  std::vector<std::string> files = {options.file};
  files.insert(files.end(), options.merged.begin(), options.merged.end());
  const CoverageReport report = read_coverage(files);
  print_coverage(report, options.missed);
  std::printf("coverage: lines %.2f %%, branches %.2f %%, toggles %.2f %%\n",
              percent(report.all[0]), percent(report.all[1]), percent(report.all[2]));
  for (const CoverageCount& count : report.all) passed = passed && percent(count) >= kEnough;
  return passed ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::Options options;
  if (!emax::parse(argc, argv, options)) {
    std::fprintf(stderr,
                 "usage: emax_coverage [--seed N] [--full] [--coverage FILE] [--merge FILE]... "
                 "[--report] [--missed]\n");
    return 2;
  }
  try {
    return emax::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_coverage: %s\n", error.what());
    return 2;
  }
}
