#pragma once

#include <map>
#include <string>
#include <vector>

namespace emax {

// One parameter of a stage of the chain (reconstruction, hole filling, decimation): a gene of the
// chromosome {P_R, P_D} (paper, section 3).
struct ParameterSpec {
  enum class Kind { kContinuous, kInteger };

  std::string name;  // unique in its chain, e.g. "gp3.mu"
  Kind kind;
  double lower;  // domain, both ends included
  double upper;
  double standard;      // the value used where no search is made
  std::string meaning;  // one line with the unit, shown in the configuration file
};

// Values by parameter name. Integers are held as whole doubles.
using ParameterValues = std::map<std::string, double>;

}  // namespace emax
