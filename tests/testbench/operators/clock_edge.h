#pragma once

namespace emax {

// A rising and a falling edge of a model's `clk`.
template <class Rtl>
void clock_edge(Rtl& rtl) {
  rtl.clk = 1;
  rtl.eval();
  rtl.clk = 0;
  rtl.eval();
}

}  // namespace emax
