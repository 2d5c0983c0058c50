#include "testbench/core/core_stimuli.h"

#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "testbench/stimuli/stimuli.h"

namespace emax::test {

std::vector<Material> materials(std::uint64_t seed) {
  std::vector<Material> all;
  for (const Stimulus& s : all_stimuli(seed)) {
    const Normalization normalization = normalization_of(s.cloud);
    all.push_back(
        {normalized_points(s.cloud, normalization), make_records(s.mesh(), normalization)});
  }
  return all;
}

namespace {

void append_any_command(std::vector<Word>& words, const std::vector<Material>& all,
                        Random& random) {
  const Material& m = all[random.below(all.size())];
  switch (random.below(10)) {
    case 0:
    case 1:
      return append_load_points(words, any_of(m.points, random.below(9), random));
    case 2:
      return append_load_points(words, any_of(m.points, random.below(100), random));
    case 3:
      if (!random.one_in(12)) return;
      return append_load_points(words, any_of(m.points, kMaxBlockPoints + random.below(3), random));
    case 4:
    case 5:
    case 6:
      return append_records(words, any_of(m.records, random.below(12), random));
    case 7:
    case 8:
      return append_reduce(words, random.one_in(2));
    default:
      if (random.one_in(3)) words.push_back(command_header(kIdentify, random.below(3)));
      if (random.one_in(8)) words.push_back(random.word() | 0x40000000u);
  }
}

}  // namespace

std::vector<Word> any_commands(const std::vector<Material>& all, std::size_t count,
                               Random& random) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < count; ++i) append_any_command(words, all, random);
  return words;
}

std::vector<Word> dense_block(const Material& m, std::size_t points, std::size_t records,
                              bool list_points, Random& random) {
  std::vector<Word> words;
  append_load_points(words, any_of(m.points, points, random));
  append_records(words, any_of(m.records, records, random));
  append_reduce(words, list_points);
  return words;
}

void name_elements(std::vector<Word>& answers, std::uint32_t elements) {
  for (std::size_t i = 0; i < answers.size(); i += 1 + header_count(answers[i])) {
    if (header_opcode(answers[i]) == kIdentify) answers[i + 4] = elements;
  }
}

}  // namespace emax::test
