// Switches on every mutant of hls/rtl/mutation.sv in turn and prints which test of the
// co-simulation catches it. Exit code 0 when all are caught and the unchanged design passes, 1
// otherwise.
//
//   emax_mutants [--list hls/rtl/mutation.sv] [--seed N] [--only TEXT]

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "sw_model/base/error.h"
#include "testbench/cosimulation/cosimulation.h"
#include "testbench/element/verilated_variants.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/operators/operator_cosim.h"
#include "testbench/operators/operator_unit.h"

namespace emax {
namespace {

constexpr std::uint64_t kOperatorPairs = 2'000'000;

// The test for a mutant that is not in the simulated element: of a family's multipliers, of
// operators for lowered functions, of a core, of the link, of what lies between them or of a
// memory's controller. Empty for a mutant of the element.
std::string other_test(const Mutant& mutant) {
  if (mutant.module.starts_with("core/")) return "core_test";
  if (mutant.module.starts_with("filter/")) return "filter_core_test";
  if (mutant.module.starts_with("board/")) return "device_core_test";
  if (mutant.module.starts_with("sdram/")) return "sdram_test";
  if (mutant.module.find('/') != std::string::npos) return "operators_test";
  if (mutant.name.starts_with("LINK_")) return "link_rtl_test";
  return {};
}

struct Catch {
  std::string test;  // that caught it; empty where none did
  std::uint64_t pairs = 0;
};

Catch catch_with_operators(std::uint32_t mutant, std::uint64_t seed) {
  const std::string name = "operators: binary32";
  const auto unit = make_mutant_operators(static_cast<int>(mutant));
  const OperatorRun run = run_operator_cosim(*unit, kOperatorPairs, named_seed(name, seed), true);
  Catch result;
  for (const OperatorResult& op : run) {
    result.pairs = op.pairs;
    if (op.mismatches > 0) result.test = name;
  }
  return result;
}

// Runs the tests in turn until one sees the mutant.
Catch find_catch(const Mutant& mutant, std::uint64_t seed) {
  const auto number = static_cast<std::uint32_t>(mutant.number);
  Catch caught;
  if (mutant.module.starts_with("fp_") || number == 0) caught = catch_with_operators(number, seed);
  if (!caught.test.empty()) return caught;
  CosimulationOptions options;
  options.seed = seed;
  options.mutant = number;
  for (const ElementTest& test : element_tests()) {
    const TestReport report = run_test(test, make_mutated_element, options);
    caught.pairs += report.pairs;
    if (!report.failure) continue;
    caught.test = report.name;
    break;
  }
  return caught;
}

int run(const std::string& list, const std::string& only, std::uint64_t seed) {
  const std::vector<Mutant> mutants = read_mutants(list);
  const Catch unchanged = find_catch({}, seed);
  if (!unchanged.test.empty()) {
    std::printf("the unchanged design fails '%s'\n", unchanged.test.c_str());
    return 1;
  }
  std::printf("%3s  %-29s %-33s %8s  %s\n", "", "mutant", "caught by", "pairs", "fault");
  std::uint64_t uncaught = 0, ran = 0;
  for (const Mutant& mutant : mutants) {
    if (mutant.name.find(only) == std::string::npos || !other_test(mutant).empty()) continue;
    const Catch caught = find_catch(mutant, seed);
    ++ran;
    uncaught += caught.test.empty() ? 1 : 0;
    std::printf("%3d  %-29s %-33s %8llu  %s: %s\n", mutant.number, mutant.name.c_str(),
                caught.test.empty() ? "NOTHING" : caught.test.c_str(),
                static_cast<unsigned long long>(caught.pairs), mutant.module.c_str(),
                mutant.fault.c_str());
    std::fflush(stdout);
  }
  if (ran == 0) throw Error("no mutant's name holds '" + only + "'");
  std::printf("mutants: %llu, not caught: %llu\n", static_cast<unsigned long long>(ran),
              static_cast<unsigned long long>(uncaught));
  for (const Mutant& mutant : mutants) {
    const std::string test = other_test(mutant);
    if (!test.empty()) std::printf("left to %s: %s\n", test.c_str(), mutant.name.c_str());
  }
  return uncaught == 0 ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  std::string list = "hls/rtl/mutation.sv", only, seed = "1";
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i];
    std::string* value = option == "--list"   ? &list
                         : option == "--only" ? &only
                         : option == "--seed" ? &seed
                                              : nullptr;
    if (value == nullptr || i + 1 == argc) {
      std::fprintf(stderr, "usage: emax_mutants [--list FILE] [--seed N] [--only TEXT]\n");
      return 2;
    }
    *value = argv[i + 1];
  }
  try {
    return emax::run(list, only, std::strtoull(seed.c_str(), nullptr, 10));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emax_mutants: %s\n", error.what());
    return 2;
  }
}
