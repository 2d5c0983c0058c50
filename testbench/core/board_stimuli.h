// Command words for both cores of a board behind its store.
#pragma once

#include <vector>

#include "testbench/core/filter_stimuli.h"

namespace emax::test {

// `count` blocks of either core in any order, with what stands around them: blocks whose commands
// are made of words of the store, in pieces; questions, echoes, words that are stored and not used.
// A store of 2^store_bits words.
std::vector<Word> any_board_commands(const Material& exact, const FilterMaterial& filter,
                                     std::size_t count, unsigned store_bits, Random& random);

}  // namespace emax::test
