// ElementSimulation for a Verilated variant of emax_element.
#pragma once

#include <verilated.h>

#include <stdexcept>

#include "testbench/element/element_simulation.h"

namespace emax {

// `Model` is a class made by Verilator from emax_element with SLOT_BITS = kSlotBits. `set_active`
// writes the active mutant of a mutation build.
template <class Model, std::uint32_t kSlotBits>
class VerilatedElement : public virtual ElementSimulation {
 public:
  using SetActive = void (*)(Model&, std::uint32_t);

  explicit VerilatedElement(SetActive set_active = nullptr)
      : model_(&context_), set_active_(set_active) {
    context_.fatalOnError(false);
    model_.clk = 0;
    model_.aresetn = 0;
    model_.eval();
  }
  ~VerilatedElement() override {
    // Verilator 5.006 removes a model's scopes from the thread's present context, even if the model
    // is of another.
    Verilated::threadContextp(&context_);
    model_.final();
  }

  std::uint32_t slot_bits() const override { return kSlotBits; }

  ElementOutputs outputs() const override {
    return {.record_ready = model_.s_axis_record_tready != 0,
            .pair_ready = model_.s_axis_point_tready != 0,
            .nearest_valid = model_.m_axis_nearest_tvalid != 0,
            .nearest_last = model_.m_axis_nearest_tlast != 0,
            .worst_valid = model_.m_axis_worst_tvalid != 0,
            .nearest = model_.m_axis_nearest_tdata,
            .worst_squared = static_cast<Word>(model_.m_axis_worst_tdata),
            .worst_index = static_cast<Word>(model_.m_axis_worst_tdata >> 32)};
  }

  void offer_record(const RecordWords* record) override {
    model_.s_axis_record_tvalid = record != nullptr;
    if (record == nullptr) return;
    for (std::uint32_t i = 0; i < kRecordWords; ++i) model_.s_axis_record_tdata[i] = (*record)[i];
  }

  void offer_pair(const Pair* pair) override {
    model_.s_axis_point_tvalid = pair != nullptr;
    if (pair == nullptr) return;
    for (std::uint32_t i = 0; i < 3; ++i) model_.s_axis_point_tdata[i] = pair->point[i];
    model_.s_axis_point_tuser = static_cast<std::uint16_t>(
        (Word(pair->first) << (kPointBits + 2)) | (Word(pair->final) << (kPointBits + 1)) |
        (Word(pair->next_record) << kPointBits) | pair->index);
    model_.s_axis_point_tlast = pair->last;
  }

  void set_ready(bool nearest, bool worst) override {
    model_.m_axis_nearest_tready = nearest;
    model_.m_axis_worst_tready = worst;
  }

  void settle() override { model_.eval(); }

  void clock(bool reset) override {
    model_.aresetn = !reset;
    model_.clk = 1;
    model_.eval();
    after_edge(context_.time());
    context_.timeInc(1);
    model_.clk = 0;
    model_.eval();
    after_edge(context_.time());
    context_.timeInc(1);
  }

  bool assertion_failed() const override { return context_.gotError(); }

  void set_mutant(std::uint32_t mutant) override {
    if (set_active_ != nullptr) {
      set_active_(model_, mutant);
    } else if (mutant != 0) {
      throw std::logic_error("this build of the element has no mutants");
    }
  }

 protected:
  Model& model() { return model_; }
  const Model& model() const { return model_; }
  VerilatedContext& context() { return context_; }
  const VerilatedContext& context() const { return context_; }
  // For waveforms: the time in half cycles.
  virtual void after_edge(std::uint64_t) {}

 private:
  VerilatedContext context_;
  Model model_;
  SetActive set_active_;
};

}  // namespace emax
