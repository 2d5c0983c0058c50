#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "hls/kernel/forms/barycentric.h"
#include "hls/kernel/word.h"
#include "hls/lowering/dataflow_graph.h"
#include "sw_model/model/flushed_float.h"
#include "testbench/stimuli/words.h"

namespace emax::test {

// A record and a point as words, so that every bit pattern gets through.
struct Sample {
  std::vector<Word> record;
  std::array<Word, 3> point;
};

using emax::any_word;

// At least `count` samples for a record of type Record<float>: triangles of all stimuli, slivers
// and degenerate ones among them, and words of any kind in every field.
std::vector<Sample> record_samples(std::uint64_t seed, std::size_t count);
std::vector<Sample> barycentric_samples(std::uint64_t seed, std::size_t count);

// The words of a graph's inputs for a sample; `p_x`, `p_y`, `p_z` are its first three inputs.
std::vector<Word> input_words(const DataflowGraph& graph, const Sample& sample);

// A sample's record and point on the model's scalar.
template <class Record>
Record flushed_record(const Sample& sample) {
  Record record;
  static_assert(sizeof(FlushedFloat) == sizeof(Word));
  std::memcpy(static_cast<void*>(&record), sample.record.data(), sizeof record);
  return record;
}
inline Vector3<FlushedFloat> flushed_point(const Sample& sample) {
  const auto value = [&](std::size_t i) { return FlushedFloat(to_float(sample.point[i])); };
  return {value(0), value(1), value(2)};
}

}  // namespace emax::test
