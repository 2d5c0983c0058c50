#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/block_search/block_search.h"
#include "host/engine/error_engine.h"
#include "host/measure/farthest_points.h"
#include "host/measure/mesh_extent.h"

namespace emax {

// The kernel's measurement of one mesh.
struct MeasuredError {
  EmaxResult kept = {};                 // over the points that are not excluded
  EmaxResult all = {};                  // over all points
  std::vector<std::uint32_t> excluded;  // indices, ascending; beyond epsilon and within the share
  bool feasible = false;
  double violation = 0;  // kernel distance over the greatest that proves e_max <= epsilon, minus 1;
                         // at most 0 when feasible
  bool operator==(const MeasuredError&) const = default;
};

// What the kernel's distances of a cloud's points from a mesh say of the bound `epsilon`, which is
// in the cloud's unit.
MeasuredError judge(const MeshExtent& mesh, const Normalization& normalization, double epsilon,
                    const FarthestPoints& points);

// The number of points in a share of `points`; 0.7% of 1,000 is 7, whatever the roundings.
std::size_t excludable_points(double share, std::size_t points);

// The nonlinear constraint e_max^2 <= epsilon^2 (paper, section 3) for one cloud, measured with the
// kernel. A feasible mesh is proven: the kernel's e_max^2 is at most the largest binary32 value
// that implies e_max <= epsilon (docs/numerics.md). With a share to exclude, that share of the
// points may be beyond epsilon.
class ErrorConstraint {
 public:
  // `epsilon` is in the cloud's unit, `excluded_share` in [0, 1). `threads` threads measure on this
  // processor; the bits are the same for any number.
  ErrorConstraint(std::span<const Point> cloud, double epsilon, double excluded_share,
                  bool brute_force = false, std::size_t threads = 1);

  ErrorConstraint(const ErrorConstraint&) = delete;  // the engine refers to the cloud
  ErrorConstraint& operator=(const ErrorConstraint&) = delete;

  // Measures on this processor.
  MeasuredError measure(MeshView mesh, const std::function<bool()>& interrupted = nullptr);
  // The same for a mesh that prepare() has prepared.
  MeasuredError measure(MeshView mesh, const PreparedMesh& prepared,
                        const std::function<bool()>& interrupted = nullptr);
  PreparedMesh prepare(MeshView mesh) const;
  // The kernel's distance of every point, in cloud order and the cloud's unit.
  std::vector<double> distances(const PreparedMesh& prepared,
                                const std::function<bool()>& interrupted = nullptr);
  // Measures in blocks on a device.
  MeasuredError measure(MeshView mesh, Evaluator& device, const SearchOptions& options = {}) const;

  // A distance, in the cloud's unit, within which the kernel's numbers prove epsilon for any mesh
  // that leaves the cloud's box by less than epsilon. Throws Error if there is none.
  double provable_distance() const;

  const PreparedCloud& cloud() const { return cloud_; }
  double epsilon() const { return epsilon_; }
  std::size_t excludable() const { return excludable_; }  // points

  // The kernel's distance in the cloud's unit.
  double in_file_units(std::uint32_t squared_bits) const;

 private:
  // Calls `nearest`, which gives every d^2, if points may be excluded, else `worst`, which gives
  // the greatest.
  MeasuredError judge(MeshView mesh, const std::function<EmaxResult()>& worst,
                      const std::function<std::vector<std::uint32_t>()>& nearest) const;

  PreparedCloud cloud_;
  ErrorEngine engine_;
  double epsilon_;
  std::size_t excludable_;
  bool brute_force_;
  std::size_t threads_;
};

}  // namespace emax
