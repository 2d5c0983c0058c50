#include <fmt/format.h>

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <vector>

#include "host/geometry/atomic_file.h"
#include "sw_model/emax_simd.h"
#include "sw_model/error.h"
#include "tests/benchmarks/cgal_peer.h"
#include "tests/benchmarks/measurement.h"

namespace emax::benchmarks {
namespace {

constexpr int kRounds = 7;

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

// The time of `way` against that of Ericson's form in float, points in random order; in brackets,
// neighbours in a row. Negative is less time.
std::string change(const Groups& groups, const std::string& way) {
  const std::optional<Spread> at_random = groups[0].ratio(way), in_a_row = groups[1].ratio(way);
  if (!at_random || !in_a_row) return "not measured";
  return fmt::format("{:+.0f} % ({:+.0f} %)", 100 * (at_random->median - 1),
                     100 * (in_a_row->median - 1));
}

std::string report(const Groups& groups) {
  std::ostringstream out;
  out << "# Benchmarks\n\nWritten by `./dev bench`: figures of one machine, not promises.\n\n";
  out << fmt::format("- {}, one thread, CPU time; SIMD targets:", processor());
  for (const SimdTarget& target : simd_targets()) out << ' ' << target.name();
  out << fmt::format("\n- GCC {}, {}, no -march; Eigen {}.{}.{}, CGAL {}, Google Benchmark {}\n",
                     __VERSION__, EMAX_BUILD_TYPE, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, CgalPeer::version(), EMAX_BENCHMARK_VERSION);
  out << fmt::format(
      "- {} rounds; each measures everything once. Times are the median "
      "over the rounds; a ratio is the median of the rounds' own ratios to the first row.\n",
      kRounds);

  const std::string best(simd_targets().front().name());
  const bool measured = groups[0].ratio(kLiteral) && groups[0].ratio(kVisibleEdge);
  if (measured) {
    out << fmt::format(
        "\nThe paper (section 4) has \"computation times 94% lower than a matrix-free approach\"; "
        "measured here against Ericson's form in float, points in random order (in brackets: "
        "neighbours in a row), the time of a pair changes by {} with the paper's literal (u, v) "
        "form and {} with the visible-edge form when called pair by pair, and by {} with the "
        "visible-edge form vectorised over points ({}).\n",
        change(groups, kLiteral), change(groups, kVisibleEdge), change(groups, simd_way(best)),
        best);
  }
  for (const Group& group : groups) group.write(out);
  return out.str();
}

// Takes `--report FILE` out of the arguments.
std::filesystem::path take_report(int& argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::string_view(argv[i]) != "--report") continue;
    const std::filesystem::path file = argv[i + 1];
    std::copy(argv + i + 2, argv + argc + 1, argv + i);
    argc -= 2;
    return file;
  }
  return {};
}

int run(int argc, char** argv) {
  const std::filesystem::path file = take_report(argc, argv);
  // First, so that the command line has the last word.
  std::vector<std::string> defaults = {argv[0], "--benchmark_min_time=0.1"};
  std::vector<char*> arguments;
  for (std::string& argument : defaults) arguments.push_back(argument.data());
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  Groups groups;
  add_pair_groups(groups);
  add_search_groups(groups);
  RecordingReporter reporter(groups);
  for (int round = 0; round < kRounds; ++round) {
    if (benchmark::RunSpecifiedBenchmarks(&reporter) == 0) return 1;
    if (reporter.empty()) return 0;  // only listed
  }
  if (reporter.failed()) return 1;
  const std::string text = report(groups);
  if (file.empty()) {
    std::cout << '\n' << text;
  } else {
    write_atomically(file, text);
  }
  return 0;
}

}  // namespace
}  // namespace emax::benchmarks

int main(int argc, char** argv) {
  try {
    return emax::benchmarks::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "emax_benchmark: " << error.what() << '\n';
    return 1;
  }
}
