#include <Vemax_ulx3s_sdram_at_speed.h>

#include "testbench/board/verilated_board.h"

namespace emax {

std::unique_ptr<BoardSimulation> make_board() {
  return std::make_unique<VerilatedBoard<Vemax_ulx3s_sdram_at_speed, 30>>();  // as CMakeLists.txt
                                                                              // builds it
}

}  // namespace emax
