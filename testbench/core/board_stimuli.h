// Command words for both cores of a board behind its store.
#pragma once

#include <span>
#include <vector>

#include "testbench/core/filter_stimuli.h"

namespace emax::test {

struct BlockSize {
  std::size_t points, records;
};

// A block of either core, some of its commands made of words of a store of 2^store_bits words.
std::vector<Word> any_board_block(const Material& exact, const FilterMaterial& filter,
                                  BlockSize size, unsigned store_bits, Random& random);

// `count` blocks of either core in any order, with what stands around them: blocks whose commands
// are made of words of the store, in pieces; questions, echoes, words that are stored and not used.
// A store of 2^store_bits words.
std::vector<Word> any_board_commands(const Material& exact, const FilterMaterial& filter,
                                     std::size_t count, unsigned store_bits, Random& random);

// All answers of a board's twin in C++ to whole commands.
std::vector<Word> answers_of_board(std::span<const Word> words, unsigned store_bits);

}  // namespace emax::test
