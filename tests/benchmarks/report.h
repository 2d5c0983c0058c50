#pragma once

#include <span>
#include <string>

#include "tests/benchmarks/groups.h"

namespace emax::benchmarks {

struct Results {
  const Groups& groups;
  std::vector<SearchGroup> searches;
  std::vector<Curve> curves;
  std::string foreign_versions;  // or why there are none
  int rounds;
};

// docs/benchmarks.md: the machine and versions, the figures that matter, a table for each group.
std::string report(const Results& results);

// [{name, axis, unit, lines: [{title, at: [...], median: [...], least: [...], greatest: [...]}]}]
std::string curves_json(std::span<const Curve> curves);

}  // namespace emax::benchmarks
