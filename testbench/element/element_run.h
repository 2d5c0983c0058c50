// One run of the element: its inputs, the patterns of its four streams, and the expected outputs.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "testbench/element/element_simulation.h"
#include "testbench/stimuli/stream_pattern.h"

namespace emax {

struct StreamPatterns {
  Pattern record = Pattern::kAlways, point = Pattern::kAlways;   // idles
  Pattern nearest = Pattern::kAlways, worst = Pattern::kAlways;  // back-pressure
  std::uint64_t seed = 0;

  bool all_willing() const {
    return record == Pattern::kAlways && point == Pattern::kAlways && nearest == Pattern::kAlways &&
           worst == Pattern::kAlways;
  }
};

// A run begins with a reset. Pairs meet the records in order and move on at next_record.
struct ElementRun {
  std::vector<RecordWords> records;
  std::vector<Pair> pairs;
  StreamPatterns patterns;
  std::optional<std::uint64_t> cut;  // cycles after which the next run's reset ends this run
};

// The words of each output by the model, in order, with the pair that caused each.
struct ExpectedNearest {
  Word squared;
  bool last;
  std::size_t pair;
};
struct ExpectedWorst {
  Word squared, index;
  std::size_t pair;
};
struct Expected {
  std::vector<ExpectedNearest> nearest;
  std::vector<ExpectedWorst> worst;
};

// The expected outputs, by pair_squared_bits and the kernel's reductions. Throws
// std::invalid_argument where the run breaks a rule of the element's streams.
Expected expected_of(const ElementRun& run);

// Whether the pairs keep the rules: each has its record, two pairs of a point are at least
// kReadModifyWrite apart, the first pair of a point in a block has the flag `first`, and a block's
// last pair is final.
bool is_legal(const ElementRun& run);

// The record that each pair meets.
std::vector<std::size_t> records_of_pairs(const ElementRun& run);

// A run as text: one line for each record or pair, hex words, comments after #. Reading throws
// Error naming the line.
void write_run(std::ostream& out, const ElementRun& run);
ElementRun read_run(std::istream& in);

TriangleRecord<float> to_record(const RecordWords& words);
RecordWords to_words(const TriangleRecord<float>& record);

}  // namespace emax
