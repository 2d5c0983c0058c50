// Command words for a filtering core: records of meshes, and numbers that belong to no triangle.
#pragma once

#include <cstdint>
#include <vector>

#include "hls/kernel/filter_words.h"
#include "testbench/core/core_stimuli.h"

namespace emax::test {

using FilterPoint = Vector3<FilterNumber>;
using FilterRecord = TriangleRecord<FilterNumber>;

struct FilterMaterial {
  std::vector<FilterPoint> points;
  std::vector<FilterRecord> records;
};

// Of all shared stimuli, each in its own filter units.
FilterMaterial filter_material(std::uint64_t seed);
// Numbers at the ends of the range, about 0 and 1, small ones and any, in points and records that
// belong to no triangle.
FilterMaterial filter_edges(std::uint64_t seed);

// One block of the given numbers of points and records of the material.
std::vector<Word> filter_block(const FilterMaterial& m, std::size_t points, std::size_t records,
                               bool list_points, Random& random);

// `count` commands in any order, as any_commands() gives, and a FilterReduce.
std::vector<Word> any_filter_commands(const std::vector<FilterMaterial>& all, std::size_t count,
                                      Random& random);

}  // namespace emax::test
