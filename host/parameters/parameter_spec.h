#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace emax {

// One parameter of a stage of the chain (reconstruction, hole filling, decimation): a gene of the
// chromosome {P_R, P_D} (paper, section 3).
struct ParameterSpec {
  enum class Kind { kContinuous, kInteger, kCategorical };
  // It has a meaning only where the categorical parameter of that name has that category, or, with
  // `unless`, has another.
  struct Condition {
    std::string parameter;
    double category;
    bool unless = false;
  };

  std::string name;  // unique in its chain, e.g. "gp3.mu"
  Kind kind;
  double lower;  // domain, both ends included
  double upper;
  double standard;      // the value used where no search is made
  std::string meaning;  // one line with the unit, shown in the configuration file
  std::vector<std::string> categories = {};  // of a categorical one: the names of 0, 1, ...
  std::optional<Condition> only_with = std::nullopt;
  // False: keeps its standard value unless the configuration gives it a domain, because a search
  // over it gains nothing.
  bool searched = true;
};

// Values by parameter name. Integers are held as whole doubles.
using ParameterValues = std::map<std::string, double>;

}  // namespace emax
