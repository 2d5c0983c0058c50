#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/block_search/block_search.h"
#include "host/engine/error_engine.h"

namespace emax {

// What the kernel says of one mesh.
struct MeasuredError {
  EmaxResult kept;                      // over the points that are kept
  EmaxResult all;                       // over all points
  std::vector<std::uint32_t> excluded;  // indices, ascending; beyond epsilon and within the share
  bool feasible;
  double violation;  // kernel distance over the greatest that proves e_max <= epsilon, minus 1;
                     // at most 0 when feasible
  bool operator==(const MeasuredError&) const = default;
};

// How many of so many points a share of them is; 0.7% of 1,000 is 7, whatever the roundings.
std::size_t excludable_points(double share, std::size_t points);

// The nonlinear constraint e_max^2 <= epsilon^2 (paper, section 3) on the kernel, for one cloud.
// Feasible means proven: the kernel's e_max^2 is at most the largest binary32 value that implies
// e_max <= epsilon (docs/numerics.md). With a share to exclude, that many of the farthest points
// may lie beyond epsilon.
class ErrorConstraint {
 public:
  // `epsilon` in the cloud's unit; `excluded_share` in [0, 1). The threads measure on this
  // processor, with the same bits however many they are.
  ErrorConstraint(std::span<const Point> cloud, double epsilon, double excluded_share,
                  bool brute_force = false, std::size_t threads = 1);

  ErrorConstraint(const ErrorConstraint&) = delete;  // the engine refers to the cloud
  ErrorConstraint& operator=(const ErrorConstraint&) = delete;

  // On this processor.
  MeasuredError measure(MeshView mesh, const std::function<bool()>& interrupted = nullptr);
  // With what the engine needs of the same mesh, made before by prepare().
  MeasuredError measure(MeshView mesh, const PreparedMesh& prepared,
                        const std::function<bool()>& interrupted = nullptr);
  PreparedMesh prepare(MeshView mesh) const;
  // The kernel's distance of every point, in cloud order and the cloud's unit.
  std::vector<double> distances(const PreparedMesh& prepared,
                                const std::function<bool()>& interrupted = nullptr);
  // In blocks on a device.
  MeasuredError measure(MeshView mesh, Evaluator& device, const SearchOptions& options = {}) const;

  // A distance, in the cloud's unit, within which the kernel's numbers prove epsilon for any mesh
  // that strays less than epsilon from the cloud's box. Throws Error where there is none.
  double provable_distance() const;

  const PreparedCloud& cloud() const { return cloud_; }
  double epsilon() const { return epsilon_; }
  std::size_t excludable() const { return excludable_; }  // points

  // The kernel's distance in the cloud's unit.
  double in_file_units(std::uint32_t squared_bits) const;

 private:
  // The greatest kernel e_max^2 that proves epsilon; nothing where not even 0 does, because epsilon
  // is below the kernel's own error.
  std::optional<std::uint32_t> threshold(MeshView mesh) const;

  // `nearest` gives every d^2, `worst` the greatest; one of them is asked.
  MeasuredError judge(MeshView mesh, const std::function<EmaxResult()>& worst,
                      const std::function<std::vector<std::uint32_t>()>& nearest) const;
  void exclude(std::span<const std::uint32_t> squared_bits, std::uint32_t allowed,
               MeasuredError& measured) const;

  PreparedCloud cloud_;
  ErrorEngine engine_;
  double epsilon_;
  std::size_t excludable_;
  bool brute_force_;
  std::size_t threads_;
};

}  // namespace emax
