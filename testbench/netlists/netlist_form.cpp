// Drives the netlist of a form of the distance, with its record memory, beside its source: random
// records and points, a pair every cycle. The tests of the lowering compare the source itself with
// the kernel.
//
// Exit code 0 where every distance equals the source's, else 1.
#include <Vnetlist_form.h>

#include <bit>
#include <cstdio>

#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::uint64_t kPairs = 30'000;
constexpr std::uint64_t kFilling = 400;  // cycles, more than any latency
constexpr std::uint32_t kSlots = 16;

// Mostly a number in the range of normalised coordinates, now and then any word.
std::uint32_t any_word(Random& random) {
  if (random.one_in(64)) return random.word();
  if (random.one_in(16)) return 0;
  return std::bit_cast<std::uint32_t>(static_cast<float>(random.uniform(-2, 2)));
}

int run() {
  VerilatedContext context;
  Vnetlist_form model(&context);
  Random random(named_seed("netlist_form", 1));
  const auto clock = [&] {
    model.clk = 0;
    model.eval();
    model.clk = 1;
    model.eval();
  };
  std::uint64_t pairs = 0, mismatches = 0;
  for (std::uint64_t round = 0; round < 10; ++round) {
    // Records are written while no pair reads them.
    for (std::uint32_t slot = 0; slot < kSlots; ++slot) {
      model.write_enable = 1;
      model.write_slot = static_cast<CData>(slot);
      for (std::size_t i = 0; i < sizeof(model.write_record) / 4; ++i) {
        model.write_record[i] = any_word(random);
      }
      clock();
    }
    model.write_enable = 0;
    for (std::uint64_t i = 0; i < kPairs / 10 + 2 * kFilling; ++i) {
      model.slot = static_cast<CData>(random.below(kSlots));
      model.p_x = any_word(random);
      model.p_y = any_word(random);
      model.p_z = any_word(random);
      clock();
      if (i < kFilling || i >= kPairs / 10 + kFilling) continue;
      ++pairs;
      if (model.source == model.netlist) continue;
      if (mismatches++ == 0) {
        std::printf("pair %llu: source %08x, netlist %08x\n",
                    static_cast<unsigned long long>(pairs), model.source, model.netlist);
      }
    }
  }
  std::printf("netlist: %llu pairs, %llu mismatches\n", static_cast<unsigned long long>(pairs),
              static_cast<unsigned long long>(mismatches));
  return mismatches == 0 && pairs > 0 ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main() { return emax::run(); }
