// Which node of the dataflow graph went wrong first: a run is replayed on an element whose probes
// show every node, and each is compared with its value on the flushing scalar.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "testbench/element_driver.h"

namespace emax {

// An element with the probes of emax_distance (EMAX_PROBES).
class ProbedElement : public virtual ElementSimulation {
 public:
  // Word `i` of the probes in the present cycle.
  virtual Word probe(std::size_t i) const = 0;
};

struct NodeMismatch {
  std::size_t pair;     // of the run
  std::string node;     // its name in the generated module
  std::string place;    // in the kernel's source
  std::uint64_t cycle;  // of the run, in which the probe shows it
  Word model, element;
};

// Records the probes of a run.
class NodeObserver : public RunObserver {
 public:
  explicit NodeObserver(const ProbedElement& element);

  void pair_accepted(std::size_t pair, std::uint64_t cycle) override;
  void cycle_ended(std::uint64_t cycle) override;

  // The first node in the order of the pipeline that differs, of the given pair; without one, of
  // the first pair that has any. Nothing where all nodes agree.
  std::optional<NodeMismatch> first_divergence(const ElementRun& run,
                                               std::optional<std::size_t> pair) const;

 private:
  const ProbedElement& element_;
  std::vector<std::uint64_t> accepted_;     // cycle, by pair
  std::vector<std::vector<Word>> history_;  // probes, by cycle
};

std::string describe(const NodeMismatch& mismatch);

}  // namespace emax
