// Co-simulation of the element: every test beside the model, and a table of them.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "sw_model/error.h"
#include "testbench/failure_handling.h"
#include "testbench/table.h"
#include "testbench/verilated_variants.h"

namespace emax {
namespace {

constexpr const char* kHelp = R"(usage: emax_cosim [OPTION...]

Runs the Verilated element beside the model. The last line is `cosim: N pairs, M mismatches`;
exit code 0 when there are none, 1 on a mismatch, 2 when it could not run, 130 when interrupted.

  --full             at least 10^7 pairs and 10^5 blocks; the default takes seconds
  --seed N           of the whole run (default 1); each test's own is derived from it and its name
  --filter TEXT      only tests whose name holds TEXT
  --list             name the tests
  --replay FOLDER    replay the folder that a failure left [--mutant N]
  --window CYCLES    of the waveform before a mismatch (default 300)
  --failures FOLDER  where failures are kept (default build/cosim-failures)
)";

std::atomic<bool> interrupted{false};

struct Options {
  bool full = false, list = false, help = false;
  std::uint64_t seed = 1, window = 300;
  std::string filter, replay, mutant, failures = "build/cosim-failures";
};

std::uint64_t number(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const std::uint64_t value = std::strtoull(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0') throw Error(option + ": '" + text + "' is not a number");
  return value;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 == argc) throw Error(argument + " needs a value; see --help");
      return argv[++i];
    };
    if (argument == "--full") {
      options.full = true;
    } else if (argument == "--list") {
      options.list = true;
    } else if (argument == "--help") {
      options.help = true;
    } else if (argument == "--seed") {
      options.seed = number(argument, value());
    } else if (argument == "--window") {
      options.window = number(argument, value());
    } else if (argument == "--filter") {
      options.filter = value();
    } else if (argument == "--replay") {
      options.replay = value();
    } else if (argument == "--mutant") {
      options.mutant = std::to_string(number(argument, value()));
    } else if (argument == "--failures") {
      options.failures = value();
    } else {
      throw Error("unknown option '" + argument + "'; see --help");
    }
  }
  return options;
}

int replay(const Options& options) {
  std::vector<std::string> arguments = {"--window", std::to_string(options.window)};
  if (!options.mutant.empty()) arguments.insert(arguments.end(), {"--mutant", options.mutant});
  return run_replay(options.replay, arguments);
}

int run(const Options& options) {
  CosimulationOptions settings;
  settings.seed = options.seed;
  settings.full = options.full;
  settings.stop = &interrupted;
  Table table;
  std::uint64_t pairs = 0, mismatches = 0, ran = 0;
  std::printf("element co-simulation, seed %llu%s\n\n",
              static_cast<unsigned long long>(options.seed), options.full ? ", full" : "");
  table.print_head();
  for (const ElementTest& test : element_tests()) {
    if (test.name.find(options.filter) == std::string::npos) continue;
    if (interrupted) break;
    settings.progress = [&](double share) { table.show_progress(test.name, share); };
    const TestReport report = run_test(test, make_plain_element, settings);
    table.print_row(report);
    ++ran;
    pairs += report.pairs;
    if (report.failure) {
      ++mismatches;
      keep_failure(*report.failure, make_plain_element, options.failures, options.window);
    }
  }
  if (ran == 0 && !interrupted) {
    throw Error("no test's name holds '" + options.filter + "'; see --list");
  }
  table.print_sum();
  if (interrupted) std::printf("interrupted: the tests above are all that ran\n");
  std::printf("cosim: %llu pairs, %llu mismatches\n", static_cast<unsigned long long>(pairs),
              static_cast<unsigned long long>(mismatches));
  return mismatches > 0 ? 1 : interrupted ? 130 : 0;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  try {
    const emax::Options options = emax::parse(argc, argv);
    if (options.help) {
      std::fputs(emax::kHelp, stdout);
      return 0;
    }
    if (options.list) {
      for (const emax::ElementTest& test : emax::element_tests()) std::puts(test.name.c_str());
      return 0;
    }
    if (!options.replay.empty()) return emax::replay(options);
    std::signal(SIGINT, [](int) { emax::interrupted = true; });
    return emax::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_cosim: %s\n", error.what());
    return 2;
  }
}
