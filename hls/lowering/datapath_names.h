// The names of everything in the module of a datapath: signals, delayed signals, constants,
// instances. They come out of one table, so no two are the same and none is a keyword.
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
  // Reads the design while it is constructed, not later.
  explicit DatapathNames(const LoweredDesign& design);

  // Cycles later than its ready cycle in which a node's value is used, in order. Constants are
  // there at all times and have none.
  const std::set<int>& taps(NodeId node) const;

  // The signal that holds a node's value in a cycle: one of its taps, or its ready cycle. A
  // constant's for any cycle.
  const std::string& signal(NodeId node, int cycle) const;

  // The constants by their words: one name a word.
  const std::map<Word, std::string>& constants() const { return constants_; }

  // The instance of the operator of a node that has one.
  const std::string& instance(NodeId node) const { return instances_.at(node); }

  // The delay line that drives the signal of a tap.
  const std::string& delay(NodeId node, int cycle) const { return delays_.at({node, cycle}); }

 private:
  std::map<NodeId, std::set<int>> taps_;
  std::map<NodeId, std::string> signals_, instances_;
  std::map<std::pair<NodeId, int>, std::string> delayed_, delays_;
  std::map<Word, std::string> constants_;
};

}  // namespace emax
