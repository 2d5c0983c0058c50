#pragma once

#include <cstddef>
#include <cstdint>

#include "host/geometry/disjoint_sets.h"
#include "host/tiles/record_bins.h"

namespace emax {

// Counts the connected components of a graph whose edges come in any order. Nodes are numbers. The
// lowest ones, as many as the memory holds, are joined at once. Each range of higher ones keeps its
// edges in a file; at the end the ranges are taken from the highest to the lowest, and every set of
// a range passes its edges on to the lower nodes that it reaches: as many edges as before at most
// (Sibeyn, "External connected components", 2004, has the idea). O(edges * ranges) time at worst.
class ComponentCount {
 public:
  // `memory`: bytes.
  ComponentCount(const NamedInput& input, std::uint64_t memory);

  void join(std::uint32_t a, std::uint32_t b);
  // Of the nodes 0 to `nodes` - 1, among which are all that were joined. Once.
  std::uint64_t count(std::uint64_t nodes);

 private:
  struct Edge {
    std::uint32_t higher, lower;
  };

  // Passes on what the nodes of a range have joined; returns the components that are complete.
  std::uint64_t finish(std::size_t range, std::uint64_t nodes);

  std::uint32_t range_;     // nodes of each range
  DisjointSets lowest_{0};  // of nodes of the lowest range
  RecordBins<Edge> edges_;  // of each other range
};

}  // namespace emax
