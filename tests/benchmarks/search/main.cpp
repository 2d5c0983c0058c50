#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_problems.h"
#include "cec2006_problems.h"
#include "peer_form.h"
#include "real_problem.h"
#include "run_search.h"
#include "staircase.h"

// Runs the search on its test functions and on scans; one line of JSON for each run, as
// search_peers.py gives them for the peers.
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
      {"without restarts", [](Settings& s) { s.restart_after = 0; }},
      {"without differential evolution", [](Settings& s) { s.differential = false; }},
      {"without adaptive frequencies", [](Settings& s) { s.adaptive_frequencies = false; }},
      {"without Sobol starts", [](Settings& s) { s.sobol_starts = false; }},
      {"without first phase", [](Settings& s) { s.first_phase = false; }},
      {"without cache", [](Settings& s) { s.cache = false; }},
      {"without uniform mutation", [](Settings& s) { s.frequency_of(uniform_mutation) = 0; }},
      {"replacement as published",
       [](Settings& s) { s.replace_worse_only = s.share_feasible = false; }},
      {"repair at random", [](Settings& s) { s.repair = RepairMethod::kRandom; }},
      {"repair of every point", [](Settings& s) { s.repair_only_promising = false; }},
      {"populations 70/70", [](Settings& s) { s.search_population = s.reference_population = 70; }},
      {"original", [](Settings& s) { s = Settings::original(); }}};
  return all;
}

std::optional<double> gap(const BenchmarkProblem& bench, Settings settings, std::uint64_t budget,
                          std::uint64_t seed) {
  settings.budget = budget;
  const auto best = testing_help::run_search(bench, settings, seed);
  if (!best || !best->evaluation.feasible()) return std::nullopt;
  return best->evaluation.objective - bench.optimum;
}

// The problems of these names, all test functions where there is none.
std::vector<BenchmarkProblem> chosen_problems(const std::vector<std::string>& names,
                                              const std::filesystem::path& data) {
  std::vector<BenchmarkProblem> functions = all_problems();
  for (BenchmarkProblem& more : cec2006_problems()) functions.push_back(std::move(more));
  functions.push_back(staircase());
  if (names.empty()) return functions;
  std::vector<BenchmarkProblem> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(functions, name, &BenchmarkProblem::name);
    chosen.push_back(found != functions.end() ? *found : real_problem(name, data));
  }
  return chosen;
}

// For a peer in another process: the problem as one line of JSON, then for every line of genes one
// of values, until the input ends.
void serve(const BenchmarkProblem& bench) {
  using nlohmann::json;
  const PeerSizes sizes = peer_sizes(bench);
  json genes = json::array();
  for (std::size_t i = 0; i < sizes.genes; ++i) genes.push_back(peer_gene(bench, i));
  std::cout << json{{"genes", genes},
                    {"inequalities", sizes.inequalities},
                    {"equalities", sizes.equalities},
                    {"optimum", bench.optimum}}
            << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    // What is not finite becomes null.
    std::cout << json(peer_values(bench, json::parse(line).get<Genes>())) << std::endl;
  }
}

void measure(const BenchmarkProblem& bench, const Way& way,
             const std::vector<std::uint64_t>& budgets, std::uint64_t seeds) {
  Settings settings;
  settings.look_ahead = 1;  // as the peers, which wait for every result
  way.change(settings);
  for (const std::uint64_t budget : budgets) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const auto found = gap(bench, settings, budget, seed);
      std::cout << nlohmann::json{{"way", way.name},
                                  {"problem", bench.name},
                                  {"budget", budget},
                                  {"seed", seed},
                                  {"optimum", bench.optimum},
                                  {"gap", found ? nlohmann::json(*found) : nlohmann::json()}}
                << std::endl;
    }
  }
}

int main(int argc, char** argv) {
  std::vector<std::string> names, chosen = {"emax"};
  std::vector<std::uint64_t> budgets = {200, 1000, 5000};
  std::uint64_t seeds = 11;
  std::filesystem::path data = "data";
  bool list = false, serving = false;
  CLI::App app("The search on test functions and scans", "emax_search_benchmark");
  app.add_option("--problems", names, "these only; one may be \"bunny 0.321 schroeder\"");
  app.add_option("--ways", chosen, "settings, see --list");
  app.add_option("--budgets", budgets, "evaluations");
  app.add_option("--seeds", seeds, "runs of each");
  app.add_option("--data", data, "folder of the scans");
  app.add_flag("--list", list, "print the ways");
  app.add_flag("--serve", serving, "evaluate the first problem for a peer");
  CLI11_PARSE(app, argc, argv);
  if (list) {
    for (const Way& way : ways()) std::cout << way.name << '\n';
    return 0;
  }
  const std::vector<BenchmarkProblem> problems = chosen_problems(names, data);
  if (serving) {
    serve(problems.front());
    return 0;
  }
  for (const BenchmarkProblem& bench : problems) {
    for (const Way& way : ways()) {
      if (std::ranges::find(chosen, way.name) != chosen.end()) measure(bench, way, budgets, seeds);
    }
  }
  return 0;
}

}  // namespace
}  // namespace emax::benchmark

int main(int argc, char** argv) {
  try {
    return emax::benchmark::main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "emax_search_benchmark: " << error.what() << '\n';
    return 1;
  }
}
