// Runs a test of the element, keeps its figures, and shrinks a failure.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "testbench/cosimulation/element_tests.h"
#include "testbench/element/element_driver.h"

namespace emax {

// Makes an element of the program's Verilated variant with the given number of slot bits.
using ElementFactory = std::function<std::unique_ptr<ElementSimulation>(std::uint32_t slot_bits)>;

struct CosimulationOptions {
  std::uint64_t seed = 1;
  bool full = false;
  std::uint64_t part = 1;  // runs one in `part` of the test's runs, at least two
  std::uint32_t mutant = 0;
  std::function<void(double)> progress;     // called now and then with the share that is done
  const std::atomic<bool>* stop = nullptr;  // ends a test after the present run
};

// A run that differs from the model. Repeated alone, or after the run that its reset cut, it
// differs again.
struct Failure {
  std::string test;
  std::uint64_t seed = 0;
  std::uint32_t slot_bits = 0, mutant = 0;
  std::vector<ElementRun> runs;
  Mismatch mismatch;  // in the last of the runs
};

struct TestReport {
  std::string name;
  std::uint64_t seed = 0;  // the test's own
  std::uint64_t pairs = 0, blocks = 0, minima = 0, cycles = 0;
  double seconds = 0;                         // of the whole test
  double simulating_seconds = 0;              // in the Verilated element and its drivers
  std::optional<double> initiation_interval;  // cycles a pair where nothing stalled; must be 1
  std::optional<Failure> failure;             // of a test of the element
  std::uint64_t mismatches = 0;
  std::optional<double> coverage;  // share in percent of the design's points that the test reaches
  bool stopped = false;
};

TestReport run_test(const ElementTest& test, const ElementFactory& make_element,
                    const CosimulationOptions& options);

// Runs a sequence on a fresh element, as run_test does. Returns the result of the last run, or of
// the first that differs.
RunResult run_sequence(const std::vector<ElementRun>& runs, ElementSimulation& element,
                       RunObserver* observer = nullptr);

// Removes what the failure does not need: the run before, patterns, pairs, records. The rest still
// differs on the element. Tries at most `tries` runs.
Failure shrink(const Failure& failure, const ElementFactory& make_element,
               std::uint32_t tries = 600);

}  // namespace emax
