#pragma once

#include <string>
#include <vector>

namespace emax {

// One line of hls/rtl/mutation.sv.
struct Mutant {
  int number = 0;
  std::string name;
  std::string module;
  std::string fault;
};

// The mutants in the order of the file. Throws Error when the file cannot be read or holds none, or
// when two mutants have one number.
std::vector<Mutant> read_mutants(const std::string& path);

}  // namespace emax
