#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_problems.h"
#include "host/genocop/genocop.h"
#include "host/genocop/look_ahead_scheduler.h"
#include "staircase.h"

// Runs the search on its test functions; one line of JSON for each run, as search_peers.py gives
// them for the peers.
namespace emax::benchmark {
namespace {

struct Way {
  std::string name;
  std::function<void(Settings&)> change;
};

// The first is the search as it is; each of the others lacks one strategy or is the original.
const std::vector<Way>& ways() {
  static const std::vector<Way> all = {
      {"emax", [](Settings&) {}},
      {"emax, look-ahead 16", [](Settings& s) { s.look_ahead = 16; }},
      {"without finish", [](Settings& s) { s.finish = false; }},
      {"without linear model", [](Settings& s) { s.linear_model = false; }},
      {"without both", [](Settings& s) { s.finish = s.linear_model = false; }},
      {"without monotone step", [](Settings& s) { s.monotone_step = false; }},
      {"without adaptive frequencies", [](Settings& s) { s.adaptive_frequencies = false; }},
      {"without Sobol starts", [](Settings& s) { s.sobol_starts = false; }},
      {"without first phase", [](Settings& s) { s.first_phase = false; }},
      {"repair at random", [](Settings& s) { s.repair = RepairMethod::kRandom; }},
      {"populations 70/70", [](Settings& s) { s.search_population = s.reference_population = 70; }},
      {"original", [](Settings& s) { s = Settings::original(); }}};
  return all;
}

std::optional<double> gap(const BenchmarkProblem& bench, Settings settings, std::uint64_t budget,
                          std::uint64_t seed) {
  settings.budget = budget;
  Genocop search(bench.problem, settings, seed);
  LookAheadScheduler scheduler(search, budget);
  while (const auto candidate = scheduler.next()) {
    scheduler.complete(candidate->index, bench.evaluate(candidate->genes));
  }
  const auto best = search.best();
  if (!best || !best->evaluation.feasible()) return std::nullopt;
  return best->evaluation.objective - bench.optimum;
}

int main(int argc, char** argv) {
  std::vector<std::string> names, chosen = {"emax"};
  std::vector<std::uint64_t> budgets = {200, 1000, 5000};
  std::uint64_t seeds = 11;
  bool list = false;
  CLI::App app("The search on g01 to g11 and the staircase", "emax_search_benchmark");
  app.add_option("--problems", names, "these only");
  app.add_option("--ways", chosen, "settings, see --list");
  app.add_option("--budgets", budgets, "evaluations");
  app.add_option("--seeds", seeds, "runs of each");
  app.add_flag("--list", list, "print the ways");
  CLI11_PARSE(app, argc, argv);
  if (list) {
    for (const Way& way : ways()) std::cout << way.name << '\n';
    return 0;
  }
  std::vector<BenchmarkProblem> problems = all_problems();
  problems.push_back(staircase());
  for (const BenchmarkProblem& bench : problems) {
    if (!names.empty() && std::find(names.begin(), names.end(), bench.name) == names.end()) {
      continue;
    }
    for (const Way& way : ways()) {
      if (std::find(chosen.begin(), chosen.end(), way.name) == chosen.end()) continue;
      Settings settings;
      settings.look_ahead = 1;  // as the peers, which wait for every result
      way.change(settings);
      for (const std::uint64_t budget : budgets) {
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
          const auto found = gap(bench, settings, budget, seed);
          std::cout
              << fmt::format(
                     R"({{"way": "{}", "problem": "{}", "budget": {}, "seed": {}, "gap": {}}})",
                     way.name, bench.name, budget, seed,
                     found ? fmt::format("{:.17g}", *found) : "null")
              << std::endl;
        }
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace emax::benchmark

int main(int argc, char** argv) { return emax::benchmark::main(argc, argv); }
