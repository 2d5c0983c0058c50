#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/emax_search/emax_search.h"

namespace emax {

// What the kernel says of one mesh.
struct MeasuredError {
  EmaxResult kept;                      // over the points that are kept
  EmaxResult all;                       // over all points
  std::vector<std::uint32_t> excluded;  // indices, ascending; beyond epsilon and within the share
  bool feasible;
  double violation;  // kernel distance over the greatest that proves e_max <= epsilon, minus 1;
                     // at most 0 when feasible
};

// The nonlinear constraint e_max^2 <= epsilon^2 (paper, section 3) on the kernel, for one cloud.
// Feasible means proven: the kernel's e_max^2 is at most the largest binary32 value that implies
// e_max <= epsilon (docs/numerics.md). With a share to exclude, that many of the farthest points
// may lie beyond epsilon.
class ErrorConstraint {
 public:
  // `epsilon` in the cloud's unit; `excluded_share` in [0, 1).
  ErrorConstraint(std::span<const Point> cloud, double epsilon, double excluded_share,
                  bool brute_force = false);

  MeasuredError measure(MeshView mesh, Evaluator& evaluator,
                        const SearchOptions& options = {}) const;

  const PreparedCloud& cloud() const { return cloud_; }
  double epsilon() const { return epsilon_; }
  std::size_t excludable() const { return excludable_; }  // points

  // The kernel's distance in the cloud's unit.
  double in_file_units(std::uint32_t squared_bits) const;

 private:
  // The greatest kernel e_max^2 that proves epsilon; nothing where not even 0 does, because epsilon
  // is below the kernel's own error.
  std::optional<std::uint32_t> threshold(MeshView mesh) const;

  void exclude(std::span<const std::uint32_t> squared_bits, std::uint32_t allowed,
               MeasuredError& measured) const;

  PreparedCloud cloud_;
  double epsilon_;
  std::size_t excludable_;
  bool brute_force_;
};

}  // namespace emax
