// Co-simulation: runs every test of operators and element beside the model and prints a table.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string_view>

#include "sw_model/base/error.h"
#include "testbench/cosimulation/coverage_report.h"
#include "testbench/cosimulation/failure_handling.h"
#include "testbench/cosimulation/suite.h"
#include "testbench/element/verilated_variants.h"

namespace emax {
namespace {

constexpr const char* kHelp = R"(usage: emax_cosim [OPTION...]

Runs the Verilated operators beside the processor's arithmetic and the Verilated element beside the
model. The last line is `cosim: N pairs, M mismatches`.
Exit code: 0 without a mismatch, 1 on a mismatch, 2 when it could not run, 130 when interrupted.

  --full             10^8 pairs an operator, 10^7 pairs and 10^5 blocks of the element; the
                     default takes seconds
  --seed N           seed of the whole run (default 1); each test's own seed is derived from it and
                     from the test's name
  --filter TEXT      run only the tests whose names contain TEXT
  --list             list the names of the tests
  --replay FOLDER    replay the folder that a failure left [--mutant N]
  --window CYCLES    cycles of the waveform before a mismatch (default 300)
  --coverage FILE    coverage of each test, written by emax_coverage, for the table
  --failures FOLDER  folder for failures (default build/cosim-failures)
)";

std::atomic<bool> interrupted{false};

struct Options {
  bool full = false, list = false, help = false;
  std::uint64_t seed = 1, window = 300;
  std::string filter, replay, mutant, coverage, failures = "build/cosim-failures";
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
    } else if (argument == "--coverage") {
      options.coverage = value();
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

int run(const Options& options, Suite suite) {
  std::map<std::string, double> coverage;
  if (!options.coverage.empty()) coverage = read_test_coverage(options.coverage);
  std::vector<Failure> failures;
  suite.finish = [&](TestReport& report) {
    if (const auto known = coverage.find(report.name); known != coverage.end()) {
      report.coverage = known->second;
    }
    if (report.failure) failures.push_back(*report.failure);
  };
  std::printf("co-simulation, seed %llu%s\n\n", static_cast<unsigned long long>(options.seed),
              options.full ? ", full" : "");
  const SuiteResult result = run_suite(suite);
  for (const Failure& failure : failures) {
    keep_failure(failure, make_plain_element, options.failures, options.window);
  }
  if (result.interrupted) std::printf("interrupted: the tests above are all that ran\n");
  std::printf("cosim: %llu pairs, %llu mismatches\n", static_cast<unsigned long long>(result.pairs),
              static_cast<unsigned long long>(result.mismatches));
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw Error("standard output cannot be written; is the disk full?");
  return result.mismatches > 0 ? 1 : result.interrupted ? 130 : 0;
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
    emax::Suite suite;
    suite.operators = emax::operator_tests(options.full);
    suite.make_element = emax::make_plain_element;
    suite.filter = options.filter;
    if (options.list) {
      for (const std::string& name : emax::test_names(suite)) std::puts(name.c_str());
      return 0;
    }
    if (!options.replay.empty()) return emax::replay(options);
    suite.options.seed = options.seed;
    suite.options.full = options.full;
    suite.options.stop = &emax::interrupted;
    std::signal(SIGINT, [](int) { emax::interrupted = true; });
    return emax::run(options, std::move(suite));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_cosim: %s\n", error.what());
    return 2;
  }
}
