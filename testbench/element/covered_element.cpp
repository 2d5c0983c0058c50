#include <Vemax_element_covered.h>
#include <verilated_cov.h>

#include "testbench/element/verilated_element.h"
#include "testbench/element/verilated_variants.h"

namespace emax {
namespace {

class CoveredElement : public VerilatedElement<Vemax_element_covered, kPairsSlotBits> {
 public:
  void write_coverage(const std::string& file) {
    context().coveragep()->write(file.c_str());
    context().coveragep()->zero();
  }
};

// An element keeps its counts, so all tests share one element.
CoveredElement& the_element() {
  static CoveredElement element;
  return element;
}

// Lends the shared element to a user that expects to own it.
class SharedElement : public ElementSimulation {
 public:
  std::uint32_t slot_bits() const override { return the_element().slot_bits(); }
  ElementOutputs outputs() const override { return the_element().outputs(); }
  void offer_record(const RecordWords* record) override { the_element().offer_record(record); }
  void offer_pair(const Pair* pair) override { the_element().offer_pair(pair); }
  void set_ready(bool nearest, bool worst) override { the_element().set_ready(nearest, worst); }
  void settle() override { the_element().settle(); }
  void clock(bool reset) override { the_element().clock(reset); }
  bool assertion_failed() const override { return the_element().assertion_failed(); }
  void set_mutant(std::uint32_t mutant) override { the_element().set_mutant(mutant); }
};

}  // namespace

std::unique_ptr<ElementSimulation> make_covered_element(std::uint32_t) {
  return std::make_unique<SharedElement>();
}

void write_coverage(const std::string& file) { the_element().write_coverage(file); }

}  // namespace emax
