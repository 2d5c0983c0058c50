// The two streams of words of a core (hls/rtl/core/emax_core.sv, hls/rtl/filter/filter_core.sv),
// one clock cycle at a time, for any Verilated variant of it.
#pragma once

#include <cstdint>
#include <memory>

#include "hls/kernel/word.h"

namespace emax {

// The registered outputs in the present cycle.
struct CoreOutputs {
  bool command_ready;
  bool answer_valid;
  bool under_way;
  Word answer;
};

class CoreSimulation {
 public:
  virtual ~CoreSimulation() = default;

  virtual std::uint32_t elements() const = 0;
  virtual CoreOutputs outputs() const = 0;
  // Inputs of the present cycle; null is no word. An input stays until it is set anew.
  virtual void offer_command(const Word* word) = 0;
  virtual void set_answer_ready(bool ready) = 0;
  // The rising edge that ends the present cycle; with `reset`, aresetn is low at it.
  virtual void clock(bool reset = false) = 0;
  // Whether an assertion of the design has failed since the start.
  virtual bool assertion_failed() const = 0;
  // Sets the active mutant; 0 is the unchanged design. Throws std::logic_error where the build has
  // no mutants.
  virtual void set_mutant(std::uint32_t mutant) = 0;
};

// The mutation build, of two elements. In the library emax_mutated_core.
std::unique_ptr<CoreSimulation> make_mutated_core();
// The same of the filtering core.
std::unique_ptr<CoreSimulation> make_mutated_filter();
// The same of both cores behind a store, of one element each.
constexpr unsigned kMutatedStoreBits = 8;
std::unique_ptr<CoreSimulation> make_mutated_device();
// The same with the store in an SDRAM (testbench/sdram/). Breaking a rule of the chip fails an
// assertion.
constexpr unsigned kSdramStoreBits = 12;
std::unique_ptr<CoreSimulation> make_mutated_device_with_sdram();

}  // namespace emax
