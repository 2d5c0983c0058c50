#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>

#include "host/optimize/optimize.h"
#include "host/run_log/record_file.h"
#include "host/run_log/run_log.h"
#include "sw_model/base/error.h"
#include "tests/host/mpi/schedule_replay.h"

namespace {

// What each evaluation took, in the order of the candidates.
std::vector<double> costs_of(const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / "evaluations.log";
  if (!std::filesystem::exists(log)) throw emax::Error(log.string() + ": no such file");
  std::map<std::uint64_t, double> costs;
  emax::RecordFile(log).read([&costs](std::span<const std::uint8_t> content) {
    const emax::LoggedEvaluation evaluation = emax::decode_evaluation(content);
    if (evaluation.index < emax::kPolishIndex) costs[evaluation.index] = evaluation.worked;
  });
  std::vector<double> values;
  for (const auto& [index, cost] : costs) values.push_back(cost);
  return values;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What the evaluations of a run would take on ranks with one worker each.");
  std::filesystem::path folder;
  std::vector<unsigned> ranks = {1, 2, 4, 8, 16};
  std::size_t look_ahead = 16;
  double message = 0.002;
  app.add_option("FOLDER", folder, "of a run, kept with --resume")->required();
  app.add_option("--ranks", ranks, "how many")->delimiter(',');
  app.add_option("--look-ahead", look_ahead, "search.look_ahead of the run");
  app.add_option("--message", message, "seconds between a result and the next evaluation");
  CLI11_PARSE(app, argc, argv);
  try {
    const std::vector<double> costs = costs_of(folder);
    for (const unsigned count : ranks) {
      const std::vector<unsigned> workers(count, 1);
      const auto replay = emax::test::replay_schedule(costs, workers, look_ahead, message);
      fmt::print("{} evaluations on {} ranks: {:.2f} s, efficiency {:.1f} %\n", costs.size(), count,
                 replay.seconds, 100 * replay.efficiency);
    }
  } catch (const emax::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
