// Switches on the faults that Yosys put into the operators' netlist, one at a time
// (hls/boards/netlists.py), and finds those that the co-simulation's stimuli do not see.
//
//   netlist_mutants LIST EXPLAINED
//
// LIST is Yosys's list of the faults, a line for each. A line of EXPLAINED is a regular expression,
// " # ", and the reason why faults whose lines in LIST match cannot be seen. Exit code 0 where
// every fault that is not seen is explained, and every explained fault is not seen, else 1.
#include <Vnetlist_mutated.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "testbench/operators/operator_cosim.h"
#include "testbench/operators/verilated_operators.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::uint64_t kPairs = 60'000;

struct Fault {
  unsigned number;  // the value of mutant_select
  std::string text;
};

std::vector<Fault> faults_of(const char* path) {
  std::vector<Fault> faults;
  std::ifstream file(path);
  const std::regex shape("mutate -ctrl mutant_select [0-9]+ ([0-9]+) (.*)");
  std::smatch parts;
  for (std::string line; std::getline(file, line);) {
    if (!std::regex_match(line, parts, shape)) throw Error("not a line of faults: " + line);
    faults.push_back({static_cast<unsigned>(std::stoul(parts[1])), parts[2]});
  }
  return faults;
}

std::vector<std::regex> explained_of(const char* path) {
  std::vector<std::regex> explained;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t middle = line.find(" # ");
    if (middle != std::string::npos) explained.emplace_back(line.substr(0, middle));
  }
  return explained;
}

bool is_seen(unsigned mutant) {
  VerilatedOperators<Vnetlist_mutated> unit;
  unit.model().mutant_select =
      static_cast<std::remove_reference_t<decltype(unit.model().mutant_select)>>(mutant);
  for (const OperatorResult& result :
       run_operator_cosim(unit, kPairs, named_seed("netlist_mutants", 1), true)) {
    if (result.mismatches != 0) return true;
  }
  return false;
}

int run(const char* list, const char* explanations) {
  const auto faults = faults_of(list);
  const auto explained = explained_of(explanations);
  std::size_t tried = 0, unseen = 0;
  int wrong = 0;
  const auto complain = [&](const char* what, const Fault& fault) {
    std::printf("%s: %s\n", what, fault.text.c_str());
    ++wrong;
  };
  for (const Fault& fault : faults) {
    bool seen = false;
    try {
      seen = is_seen(fault.number);
    } catch (const Error&) {
      seen = true;  // the netlist lost results of a batch
    }
    if (fault.number == 0) {
      if (seen) complain("the netlist without a fault differs", fault);
      continue;
    }
    ++tried;
    if (!seen) ++unseen;
    const bool known = std::ranges::any_of(
        explained, [&](const std::regex& e) { return std::regex_search(fault.text, e); });
    if (!seen && !known) complain("not seen", fault);
    if (seen && known) complain("explained as one that cannot be seen, but seen", fault);
  }
  if (tried == 0) ++wrong;
  std::printf("netlist: %zu faults, %zu not seen and explained, %d wrong\n", tried, unseen, wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  try {
    if (argc == 3) return emax::run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "netlist_mutants: %s\n", error.what());
    return 1;
  }
  std::fprintf(stderr, "usage: netlist_mutants LIST EXPLAINED\n");
  return 2;
}
