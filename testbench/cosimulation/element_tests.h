// The list of co-simulation tests of the element.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "testbench/element/element_run.h"

namespace emax {

struct ElementTest {
  std::string name;
  std::uint32_t slot_bits;              // of the element it is run on
  std::uint64_t quick_runs, full_runs;  // how often `make` is called
  // One unit of work: usually one run, or two where the reset of the second cuts the first. A pure
  // function of the number and the random stream.
  std::function<std::vector<ElementRun>(std::uint64_t number, Random& random)> make;
  // Whether a pair must be accepted in every cycle between the first and the last where no stream
  // idles or presses back.
  bool ii_is_one = true;
};

const std::vector<ElementTest>& element_tests();

// The pairs of a block in the order in which a core drives them: record after record, each with all
// points. Fewer points than kReadModifyWrite are padded with pairs that are not final.
void append_block(ElementRun& run, std::span<const std::array<Word, 3>> points,
                  std::span<const RecordWords> records);

}  // namespace emax
