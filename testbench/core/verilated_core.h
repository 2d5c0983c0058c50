// CoreSimulation for a Verilated variant of emax_core.
#pragma once

#include <verilated.h>

#include <stdexcept>

#include "testbench/core/core_simulation.h"

namespace emax {

// `Model` is a class made by Verilator from emax_core with NUM_PE = kElements. `set_active` writes
// the active mutant of a mutation build.
template <class Model, std::uint32_t kElements>
class VerilatedCore : public CoreSimulation {
 public:
  using SetActive = void (*)(Model&, std::uint32_t);

  explicit VerilatedCore(SetActive set_active = nullptr)
      : model_(&context_), set_active_(set_active) {
    context_.fatalOnError(false);
    model_.clk = 0;
    model_.aresetn = 0;
    model_.s_axis_command_tvalid = 0;
    model_.m_axis_answer_tready = 0;
    model_.eval();
    clock(true);
    clock(true);
  }
  ~VerilatedCore() override {
    // Verilator 5.006 removes a model's scopes from the thread's present context, even if the model
    // is of another.
    Verilated::threadContextp(&context_);
    model_.final();
  }

  std::uint32_t elements() const override { return kElements; }

  CoreOutputs outputs() const override {
    return {.command_ready = model_.s_axis_command_tready != 0,
            .answer_valid = model_.m_axis_answer_tvalid != 0,
            .under_way = model_.under_way != 0,
            .answer = model_.m_axis_answer_tdata};
  }

  void offer_command(const Word* word) override {
    model_.s_axis_command_tvalid = word != nullptr;
    if (word != nullptr) model_.s_axis_command_tdata = *word;
  }

  void set_answer_ready(bool ready) override { model_.m_axis_answer_tready = ready; }

  void clock(bool reset = false) override {
    model_.aresetn = !reset;
    model_.clk = 1;
    model_.eval();
    model_.clk = 0;
    model_.eval();
    context_.timeInc(2);
  }

  bool assertion_failed() const override { return context_.gotError(); }

  void set_mutant(std::uint32_t mutant) override {
    if (set_active_ != nullptr) {
      set_active_(model_, mutant);
    } else if (mutant != 0) {
      throw std::logic_error("this build of the core has no mutants");
    }
  }

 private:
  VerilatedContext context_;
  Model model_;
  SetActive set_active_;
};

}  // namespace emax
