#include "testbench/operators/mutant_list.h"

#include <fstream>
#include <regex>
#include <set>

#include "sw_model/base/error.h"

namespace emax {

std::vector<Mutant> read_mutants(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot be read; it should list the mutants");
  static const std::regex pattern(R"(\s*localparam int (\w+) = (\d+);\s*// ([^:]+): (.*))");
  std::vector<Mutant> mutants;
  std::set<int> numbers;
  std::smatch parts;
  for (std::string line; std::getline(file, line);) {
    if (!std::regex_match(line, parts, pattern)) continue;
    const int number = std::stoi(parts[2]);
    if (!numbers.insert(number).second) {
      throw Error(path + ": mutant number " + parts[2].str() + " stands twice; give each its own");
    }
    mutants.push_back({number, parts[1], parts[3], parts[4]});
  }
  if (mutants.empty()) throw Error(path + ": lists no mutants (localparam int NAME = NUMBER;)");
  return mutants;
}

}  // namespace emax
