#include "host/tiles/component_count.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();

// The parents of a node of the lowest range and of one in the range that is finished, and the node
// that this one reaches.
constexpr std::uint64_t kBytesOfANode = 12;
constexpr std::uint64_t kBinShare = 8;  // of the memory, for the edges on their way to the file

std::uint32_t nodes_in(std::uint64_t memory) {
  const std::uint64_t nodes = (memory - memory / kBinShare) / kBytesOfANode;
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(nodes, 4, kNoNode));
}

}  // namespace

ComponentCount::ComponentCount(const NamedInput& input, std::uint64_t memory)
    : range_(nodes_in(memory)), edges_(input, 16, memory / kBinShare) {}

void ComponentCount::join(std::uint32_t a, std::uint32_t b) {
  if (a < b) std::swap(a, b);
  if (a >= range_) {
    edges_.add(a / range_, {a, b});
    return;
  }
  if (a >= lowest_.size()) {
    lowest_.grow(std::min<std::size_t>(range_, std::max<std::size_t>(a + 1, 2 * lowest_.size())));
  }
  lowest_.join(a, b);
}

std::uint64_t ComponentCount::count(std::uint64_t nodes) {
  std::uint64_t components = 0;
  for (std::size_t range = edges_.bins(); range-- > 1;) components += finish(range, nodes);
  // Nodes beyond all that were joined are components of their own.
  const std::uint64_t in_ranges = std::max<std::uint64_t>(edges_.bins(), 1) * range_;
  if (nodes > in_ranges) components += nodes - in_ranges;
  const std::uint64_t lowest = std::min<std::uint64_t>(nodes, range_);
  components += lowest;
  for (std::size_t i = 0; i < std::min<std::uint64_t>(lowest, lowest_.size()); ++i) {
    if (lowest_.root(i) != i) --components;
  }
  return components;
}

std::uint64_t ComponentCount::finish(std::size_t range, std::uint64_t nodes) {
  const std::uint64_t first = range * std::uint64_t{range_};
  if (first >= nodes) return 0;
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(range_, nodes - first));
  DisjointSets sets(size);
  edges_.for_each(range, [&](const Edge& e) {
    if (e.lower >= first) sets.join(e.higher - first, e.lower - first);
  });
  std::vector<std::uint32_t> reached(size, kNoNode);  // of each set, a node below the range
  edges_.for_each(range, [&](const Edge& e) {
    if (e.lower >= first) return;
    std::uint32_t& known = reached[sets.root(e.higher - first)];
    if (known == kNoNode) {
      known = e.lower;
    } else if (known != e.lower && !EMAX_FAULT(kForgetsPassedEdges)) {
      join(known, e.lower);
    }
  });
  std::uint64_t complete = 0;
  for (std::size_t i = 0; i < size; ++i) complete += sets.root(i) == i && reached[i] == kNoNode;
  return complete;
}

}  // namespace emax
