#pragma once

#include <functional>

#include "host/block_search/evaluator.h"
#include "host/block_search/triangle_tree.h"
#include "host/engine/prepared_cloud.h"

namespace emax {

// The search for e_max (paper, section 4.1; docs/numerics.md). It walks groups of neighbouring
// points. An upper bound from the triangles that the kd-tree hints at, and from those nearest to
// the group's worst points, settles most groups against the running maximum R. For the other groups
// the AABB-tree gives the candidates: every triangle whose lower bound, less the margin kappa, does
// not exceed the group's upper bound. Blocks of points and candidates go to the evaluator. The
// result, including the worst index, equals that of brute force bit for bit.
struct SearchOptions {
  // Block b is prepared with the R of the answers up to block b - depth. The counts of blocks,
  // pairs and words are therefore the same for every device.
  std::size_t depth = 4;
  // Called between blocks; true ends the search with Interrupted.
  std::function<bool()> interrupted = nullptr;
};

EmaxResult search_emax(const PreparedCloud& cloud, const TriangleTree& mesh, Evaluator& evaluator,
                       const SearchOptions& options = {});

// The kernel's squared distance of every point, in cloud order: the search without R.
std::vector<std::uint32_t> search_nearest(const PreparedCloud& cloud, const TriangleTree& mesh,
                                          Evaluator& evaluator, const SearchOptions& options = {});

// All pairs, in blocks of consecutive points. O(points * triangles).
EmaxResult brute_force_emax(const PreparedCloud& cloud, const TriangleTree& mesh,
                            Evaluator& evaluator, const SearchOptions& options = {});
std::vector<std::uint32_t> brute_force_nearest(const PreparedCloud& cloud, const TriangleTree& mesh,
                                               Evaluator& evaluator,
                                               const SearchOptions& options = {});

}  // namespace emax
