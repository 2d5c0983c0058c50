// Drives the element's netlist beside the model, with the tests of the source's co-simulation that
// are for an element of 16 record slots.
//
// Prints the first word of each test that differs. Exit code 0 where every word equals the model's,
// else 1.
#include <Vnetlist_element.h>

#include <cstdio>

#include "testbench/cosimulation/cosimulation.h"
#include "testbench/element/verilated_element.h"

int main() {
  const emax::ElementFactory make = [](std::uint32_t) {
    return std::make_unique<emax::VerilatedElement<Vnetlist_element, emax::kDeviceSlotBits>>();
  };
  std::uint64_t pairs = 0, mismatches = 0;
  for (const emax::ElementTest& test : emax::element_tests()) {
    if (test.slot_bits != emax::kDeviceSlotBits) continue;
    const emax::TestReport report = emax::run_test(test, make, {});
    std::printf("%s: %llu pairs, %llu mismatches\n", report.name.c_str(),
                static_cast<unsigned long long>(report.pairs),
                static_cast<unsigned long long>(report.mismatches));
    if (report.failure) {
      const emax::Mismatch& first = report.failure->mismatch;
      std::printf("  %s, beat %llu, cycle %llu: %s\n", first.stream.c_str(),
                  static_cast<unsigned long long>(first.sample),
                  static_cast<unsigned long long>(first.cycle), first.what.c_str());
    }
    pairs += report.pairs;
    mismatches += report.mismatches;
  }
  std::printf("netlist: %llu pairs, %llu mismatches\n", static_cast<unsigned long long>(pairs),
              static_cast<unsigned long long>(mismatches));
  return mismatches == 0 && pairs > 0 ? 0 : 1;
}
