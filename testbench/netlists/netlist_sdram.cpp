// Drives the netlist of sdram_controller before the chip that judges it, beside a memory in C++.
//
//   netlist_sdram [ROUNDS]
//
// Exit code 0 where every word is right and no rule of the chip is broken, else 1.
#include <Vnetlist_sdram.h>

#include <cstdio>
#include <cstdlib>

#include "testbench/sdram/sdram_driver.h"

int main(int argc, char** argv) {
  const std::uint64_t rounds = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 28;
  emax::SdramBench<Vnetlist_sdram> bench;
  std::uint32_t broken = 0;
  for (const std::uint32_t words : {1u << 12, 1u << 22}) {
    broken |= emax::broken_by(bench, words, rounds);
  }
  std::printf("netlist: %llu rounds, rules broken: %08x\n", static_cast<unsigned long long>(rounds),
              broken);
  return broken == 0 && rounds > 0 ? 0 : 1;
}
