// The names in the module of a datapath: signals, delayed signals, constants and instances. One
// table gives them all, so no two are the same and none is a keyword.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "hls/kernel/word.h"
#include "hls/lowering/designs.h"

namespace emax {

class DatapathNames {
 public:
  // Reads the design only during construction.
  explicit DatapathNames(const LoweredDesign& design);

  // The cycles after its ready cycle in which a node's value is used, in order. A constant is
  // available in every cycle and has none.
  const std::set<int>& taps(NodeId node) const;

  // The signal that holds a node's value in a cycle, which must be one of its taps or its ready
  // cycle. For a constant any cycle is permitted.
  const std::string& signal(NodeId node, int cycle) const;

  // The constants by their width and their bits: one name for each.
  using ConstantKey = std::pair<int, std::uint64_t>;
  const std::map<ConstantKey, std::string>& constants() const { return constants_; }

  // The instance of a node's operator. The node must have one.
  const std::string& instance(NodeId node) const { return instances_.at(node); }

  // The delay line that drives the signal of a tap.
  const std::string& delay(NodeId node, int cycle) const { return delays_.at({node, cycle}); }

 private:
  std::map<NodeId, std::set<int>> taps_;
  std::map<NodeId, std::string> signals_, instances_;
  std::map<std::pair<NodeId, int>, std::string> delayed_, delays_;
  std::map<ConstantKey, std::string> constants_;
};

}  // namespace emax
