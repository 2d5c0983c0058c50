// Command words for a core, made of the shared stimuli.
#pragma once

#include <cstdint>
#include <vector>

#include "hls/kernel/scalar.h"
#include "hls/kernel/triangle_record.h"
#include "hls/kernel/word.h"
#include "testbench/stimuli/random.h"

namespace emax::test {

// Normalised points and records of one stimulus.
struct Material {
  std::vector<Vector3<float>> points;
  std::vector<TriangleRecord<float>> records;
};
std::vector<Material> materials(std::uint64_t seed);

// `count` of the values, drawn with repetition.
template <class Value>
std::vector<Value> any_of(const std::vector<Value>& values, std::size_t count, Random& random) {
  std::vector<Value> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(values[random.below(values.size())]);
  }
  return chosen;
}

// `count` commands in any order: blocks of all sizes, given up, without records, reduced twice;
// records before points, too many points, unknown opcodes.
std::vector<Word> any_commands(const std::vector<Material>& all, std::size_t count, Random& random);

// One block of the given numbers of points and records of the material.
std::vector<Word> dense_block(const Material& m, std::size_t points, std::size_t records,
                              bool list_points, Random& random);

// Writes the number of elements into every answer to Identify. The C++ top answers one element and
// no clock; a core answers its own.
void name_elements(std::vector<Word>& answers, std::uint32_t elements);

}  // namespace emax::test
