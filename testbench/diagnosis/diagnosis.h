// Finds the node of the dataflow graph that went wrong first. A run is replayed on an element whose
// probes show every node, and each node is compared with its value on the flushing scalar.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hls/lowering/dataflow_graph.h"
#include "testbench/element/element_driver.h"

namespace emax {

// An element with the probes of emax_distance (EMAX_PROBES).
class ProbedElement : public virtual ElementSimulation {
 public:
  // Word `i` of the probes in the present cycle.
  virtual Word probe(std::size_t i) const = 0;
  // Input `i` of the graph of emax_distance, at the datapath's port in the present cycle.
  virtual Word input(std::size_t i) const = 0;
};

// An operand of a node that went wrong.
struct OperandValue {
  NodeId node;
  std::string name;    // in the generated module
  std::string signal;  // that the operator reads: the operand, or its delayed value
  ValueKind kind;
  Word model;
  std::optional<Word> element;  // the element's value when it is ready; none for a constant

  bool differs() const { return element && *element != model; }
};

struct NodeMismatch {
  std::size_t pair;  // of the run
  NodeId node;
  std::string name;       // in the generated module
  std::string operation;  // add, select, ...
  std::string place;      // in the kernel's source, from the root of the project
  ValueKind kind;
  std::uint64_t start;  // cycle of the run in which the node reads its operands
  std::uint64_t cycle;  // cycle of the run in which the probe shows its value
  Word model, element;
  std::vector<OperandValue> operands;
};

// Records the probes of a run.
class NodeObserver : public RunObserver {
 public:
  explicit NodeObserver(const ProbedElement& element);

  void pair_accepted(std::size_t pair, std::uint64_t cycle) override;
  void cycle_ended(std::uint64_t cycle) override;

  // The first node that differs, in the order of the pipeline: of the given pair or, without one,
  // of the first pair that has such a node. Nothing where all nodes agree.
  std::optional<NodeMismatch> first_divergence(const ElementRun& run,
                                               std::optional<std::size_t> pair) const;

 private:
  // The element's value of a node of pair `p` when it was ready, if the run went on so long.
  std::optional<Word> shown(std::size_t p, NodeId node) const;

  const ProbedElement& element_;
  std::vector<std::uint64_t> accepted_;  // cycle, by pair
  // Words of the probes and of the inputs, by cycle.
  std::vector<std::vector<Word>> probes_, inputs_;
};

// Describes the node with its values in model and element, then each operand: name, bits, value.
std::string describe(const NodeMismatch& mismatch);

// Describes the pair as it was sent and, by the model, what the reductions after the datapath read
// for it: its squared distance, the least so far of its point, the worst point so far of its block.
std::string describe_pair(const ElementRun& run, std::size_t pair);

}  // namespace emax
