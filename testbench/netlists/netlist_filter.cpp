// Drives the netlist of a filtering core of EMAX_FILTER_ELEMENTS beside its twin in C++: commands
// in any order, with idle cycles and back-pressure, and dense blocks.
//
//   netlist_filter [ROUNDS]
//
// Exit code 0 where every answer equals the twin's, else 1.
#include <Vnetlist_core.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "testbench/core/core_driver.h"
#include "testbench/core/filter_stimuli.h"
#include "testbench/core/verilated_core.h"

namespace emax {
namespace {

int run(std::uint64_t rounds) {
  VerilatedCore<Vnetlist_core, EMAX_FILTER_ELEMENTS> core;
  const std::uint64_t seed = named_seed("netlist_filter", 1);
  const std::vector<test::FilterMaterial> all = {test::filter_material(seed),
                                                 test::filter_edges(seed)};
  std::uint64_t answers = 0, mismatches = 0, cycles = 0;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    Random random(seed + round);
    auto words = test::any_filter_commands(all, 12, random);
    const auto dense = test::filter_block(all[round % all.size()], 1 + random.below(120),
                                          1 + random.below(6), true, random);
    words.insert(words.end(), dense.begin(), dense.end());
    const CorePatterns patterns = {static_cast<Pattern>(random.below(kPatterns)),
                                   static_cast<Pattern>(random.below(kPatterns)), round};
    auto expected = answers_of_filter(words);
    test::name_elements(expected, core.elements());
    auto given = run_core(core, words, patterns, &cycles);
    given.resize(expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (given[i] == expected[i]) continue;
      if (mismatches++ == 0) {
        std::printf("round %llu, answer word %zu: expected %08x, netlist %08x\n",
                    static_cast<unsigned long long>(round), i, expected[i], given[i]);
      }
    }
    answers += expected.size();
  }
  std::printf("netlist: %llu answer words in %llu cycles, %llu mismatches\n",
              static_cast<unsigned long long>(answers), static_cast<unsigned long long>(cycles),
              static_cast<unsigned long long>(mismatches));
  return mismatches == 0 && answers > 0 ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  try {
    return emax::run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20);
  } catch (const std::exception& error) {
    std::printf("netlist: %s\n", error.what());
    return 1;
  }
}
