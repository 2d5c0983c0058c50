#include <gtest/gtest.h>

#include "sw_model/base/error.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "testbench/core/core_driver.h"
#include "testbench/operators/mutant_list.h"
#include "testbench/stimuli/stimuli.h"

namespace emax {
namespace {

// Blocks that end, are given up, are reduced twice, are too large; few points and many; ties.
std::vector<Word> every_kind_of_block() {
  const test::Stimulus s = test::bumpy_sphere(6, 9, 40, 3);
  const Normalization normalization = normalization_of(s.cloud);
  const auto points = normalized_points(s.cloud, normalization);
  const auto records = make_records(s.mesh(), normalization);
  std::vector<Word> words;
  for (const std::size_t count : {1, 2, 3, 7, 40}) {
    for (const bool list_points : {false, true}) {
      append_load_points(words, std::span(points).first(count));
      append_records(words, std::span(records).first(3));
      append_reduce(words, list_points);
    }
    append_reduce(words, false);
    append_load_points(words, std::span(points).first(count));
    append_records(words, std::span(records).first(4));
  }
  // All points of one distance: the lowest index must win whichever element has it.
  const std::vector<Vector3<float>> alike(9, points[0]);
  append_load_points(words, std::vector<Vector3<float>>(kMaxBlockPoints + 1, points[0]));
  append_reduce(words, false);
  append_load_points(words, alike);
  append_records(words, std::span(records).first(2));
  append_reduce(words, false);
  // Element 0 has the later of two worst points.
  std::vector<Vector3<float>> two(4, points[0]);
  two[1] = two[2] = {points[0].x + 1, points[0].y, points[0].z};
  append_load_points(words, two);
  append_records(words, std::span(records).first(2));
  append_reduce(words, false);
  return words;
}

bool is_caught(std::uint32_t mutant) {
  const auto words = every_kind_of_block();
  const auto core = make_mutated_core();
  core->set_mutant(mutant);
  core->clock(true);
  try {
    return run_core(*core, words) != answers_of_kernel(words);
  } catch (const Error&) {
    return true;  // an assertion, or no end
  }
}

TEST(CoreMutants, EachIsCaught) {
  EXPECT_FALSE(is_caught(0));
  std::size_t mutants = 0;
  for (const Mutant& mutant : read_mutants(EMAX_MUTATION_LIST)) {
    if (!mutant.module.starts_with("core/")) continue;
    ++mutants;
    EXPECT_TRUE(is_caught(static_cast<std::uint32_t>(mutant.number))) << mutant.name;
  }
  EXPECT_GE(mutants, 8u);
}

}  // namespace
}  // namespace emax
