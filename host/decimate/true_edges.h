#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "host/decimate/decimation_state.h"
#include "host/features/shapes.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// Points of the edges at which a surface turns by more than 40 degrees, about `spacing` apart:
// where triangles of different shapes meet, moved into the place of both; where that is farther
// than the spacing, no point. With `smooth` also where a triangle follows no shape: of noise such
// edges tell nothing. `shape_of` is the number of each triangle's shape, or kNoIndex.
// O(n log n + points).
std::vector<Point> sample_true_edges(const TriangleMesh& mesh, std::span<const Shape> shapes,
                                     std::span<const std::uint32_t> shape_of, bool smooth,
                                     double spacing);

// How far true edges are from the edges of a mesh at which it turns by more than 20 degrees. Each
// sample of a true edge belongs to the nearest of these.
class TrueEdges {
 public:
  TrueEdges() = default;  // none
  // Samples farther than `reach` from every edge belong to none.
  TrueEdges(std::vector<Point> samples, double reach)
      : samples_(std::move(samples)), reach_(reach) {}

  bool empty() const { return samples_.empty(); }
  // Gives each sample its edge, until edits other than moves. O((samples + triangles) log
  // triangles).
  void assign(const DecimationState& state);
  // The sum of the distances from the edges at a vertex, if it were `there`, to their samples.
  // Safe for concurrent use, as is step().
  double distance(const EditableMesh& mesh, std::uint32_t vertex, const Point& there) const;
  // One step of reweighted least squares to a place where that sum is less, in the directions onto
  // which `along` projects.
  Point step(const EditableMesh& mesh, std::uint32_t vertex, const Point& from,
             const Eigen::Matrix3d& along) const;

 private:
  void take_edges(const DecimationState& state);
  template <class Visit>
  void for_each_sample(std::uint32_t vertex, const Visit& visit) const;

  std::vector<Point> samples_;
  double reach_ = 0;
  std::vector<std::array<std::uint32_t, 2>> edges_;    // the lower vertex first
  std::vector<std::vector<std::uint32_t>> of_edge_;    // samples
  std::vector<std::vector<std::uint32_t>> at_vertex_;  // edges
};

}  // namespace emax
