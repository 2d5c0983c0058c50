#pragma once

#include <memory>
#include <span>
#include <type_traits>

#include <verilated.h>

#include "sw_model/base/error.h"
#include "testbench/operators/operator_unit.h"
#if VM_COVERAGE
#include <verilated_cov.h>
#endif

namespace emax {

// OperatorUnit on any Verilated variant of emax_operators.
template <class Model>
class VerilatedOperators : public OperatorUnit {
 public:
  VerilatedOperators() : context_(std::make_unique<VerilatedContext>()), model_(context_.get()) {}

  // Verilator 5.006 removes a model's scopes from the thread's present context, even if the model
  // is of another.
  ~VerilatedOperators() override { Verilated::threadContextp(context_.get()); }

  Model& model() { return model_; }

  void run(std::span<const OperandPair> pairs, std::span<OperatorResults> results) override {
    constexpr std::size_t kFlush = 64;  // cycles, more than any latency
    cycles_ += pairs.size() + kFlush;
    std::size_t received = 0;
    for (std::size_t cycle = 0; cycle < pairs.size() + kFlush; ++cycle) {
      const bool sending = cycle < pairs.size();
      const OperandPair pair = sending ? pairs[cycle] : OperandPair{0, 0};
      model_.valid_in = sending;
      model_.a = static_cast<std::remove_reference_t<decltype(model_.a)>>(pair.a);
      model_.b = static_cast<std::remove_reference_t<decltype(model_.b)>>(pair.b);
      model_.clk = 0;
      model_.eval();
      model_.clk = 1;
      model_.eval();
      if (!model_.valid) continue;
      if (received == results.size()) break;
      results[received++] = {
          {model_.sum, model_.difference, model_.product, model_.square, model_.less}};
    }
    if (received != pairs.size()) throw Error("operators: the RTL lost results of a batch");
  }

  std::uint64_t cycles() const override { return cycles_; }

  void write_coverage([[maybe_unused]] const std::string& path) override {
#if VM_COVERAGE
    context_->coveragep()->write(path.c_str());
#else
    throw Error("operators: no coverage in this build");
#endif
  }

 private:
  std::unique_ptr<VerilatedContext> context_;
  Model model_;
  std::uint64_t cycles_ = 0;
};

}  // namespace emax
