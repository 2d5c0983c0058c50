#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <vector>

#include "host/files/atomic_file.h"
#include "tests/benchmarks/foreign_peers.h"
#include "tests/benchmarks/report.h"

namespace emax::benchmarks {
namespace {

struct Options {
  CaseFolders folders{"data", "build/bench/cases"};
  std::filesystem::path report, plots;
  std::string peers;
  std::vector<std::string> parts;
  int rounds = 7;
  bool quick = false;
  std::vector<std::string> others;  // Google Benchmark's own
};

constexpr std::array kParts = {"pairs", "search", "sequences", "threads", "scaling"};

int run(const std::string& program, const Options& options) {
  // The command line has the last word.
  std::vector<std::string> words = {program, "--benchmark_min_time=0.1"};
  words.insert(words.end(), options.others.begin(), options.others.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  const auto wanted = [&](std::string_view part) {
    return std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
  };
  Groups groups;
  Results results{groups, {}, {}, "no Python peers", options.rounds};
  if (wanted("pairs")) add_pair_groups(groups);
  if (wanted("search")) {
    results.searches = add_search_groups(groups, options.folders, options.quick);
  }
  if (wanted("sequences")) add_sequence_groups(groups, options.folders, options.quick);
  if (wanted("threads") && !options.quick) add_thread_groups(groups, options.folders);
  if (wanted("scaling") && !options.quick) {
    results.curves = add_scaling_groups(groups, options.folders);
  }
  RecordingReporter reporter(groups);
  for (int round = 0; round < options.rounds; ++round) {
    if (benchmark::RunSpecifiedBenchmarks(&reporter) == 0) return 1;
    if (reporter.empty()) return 0;  // only listed
    if (!results.searches.empty()) {
      results.foreign_versions =
          measure_foreign_peers(options.peers, options.folders.cache, results.searches);
    }
  }
  if (reporter.failed()) return 1;
  if (!options.plots.empty()) write_atomically(options.plots, curves_json(results.curves));
  const std::string text = report(results);
  if (options.report.empty()) {
    std::cout << '\n' << text;
  } else {
    write_atomically(options.report, text);
  }
  return 0;
}

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Benchmarks of emax beside its peers; `./dev bench` runs them", "emax_benchmark");
  app.add_option("--data", options.folders.data, "folder of the scans")->capture_default_str();
  app.add_option("--cache", options.folders.cache, "folder of meshes made once")
      ->capture_default_str();
  app.add_option("--report", options.report, "write the tables to this file, not to the terminal");
  app.add_option("--plots", options.plots, "write to this file, as JSON, what is to be plotted");
  app.add_option("--part", options.parts, "measure these parts only")->check(CLI::IsMember(kParts));
  app.add_option("--peers", options.peers, "command that measures the peers in Python");
  app.add_option("--rounds", options.rounds, "how often everything is measured")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_flag("--quick", options.quick, "the smallest case only");
  app.allow_extras();
  CLI11_PARSE(app, argc, argv);
  options.others = app.remaining();
  if (options.parts.empty()) options.parts.assign(kParts.begin(), kParts.end());
  return run(argv[0], options);
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  try {
    return emax::benchmarks::main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "emax_benchmark: " << error.what() << '\n';
    return 1;
  }
}
