#include "testbench/core/filter_stimuli.h"

#include <iterator>

#include "sw_model/model/fixed_filter.h"
#include "sw_model/protocol/commands.h"

namespace emax::test {

FilterMaterial filter_material(std::uint64_t seed) {
  FilterMaterial all;
  for (const Material& m : materials(seed)) {
    const int exponent = filter_exponent(m.points, m.records, kFilterBits);
    for (const auto& p : m.points) {
      all.points.push_back(filter_point<kFilterBits>(p, exponent));
    }
    for (const auto& r : m.records) {
      if (const auto fixed = filter_record<kFilterBits>(r, exponent)) all.records.push_back(*fixed);
    }
  }
  return all;
}

FilterMaterial filter_edges(std::uint64_t seed) {
  Random random(seed);
  const auto number = [&random] {
    constexpr std::int64_t kEnds[] = {-131072, -131071, 131071, 65536, 65535, -65536, 0, 1, -1};
    if (random.one_in(6)) return FilterNumber::from_raw(kEnds[random.below(std::size(kEnds))]);
    const std::uint32_t most = random.one_in(3) ? 1u << 18 : 1u << 14;
    return FilterNumber::from_raw(std::int64_t{random.below(most)} - most / 2);
  };
  FilterMaterial all;
  for (int i = 0; i < 300; ++i) {
    const FilterNumber x = number(), y = number(), z = number();
    all.points.push_back({x, y, z});
    FilterRecord record{};
    for_each_scalar([&](FilterNumber& scalar) { scalar = number(); }, record);
    record.tag = random.one_in(3) ? kSegmentFlag : 0;
    all.records.push_back(record);
  }
  return all;
}

std::vector<Word> filter_block(const FilterMaterial& m, std::size_t points, std::size_t records,
                               bool list_points, Random& random) {
  std::vector<Word> words;
  append_filter_points(words, any_of(m.points, points, random));
  append_filter_records(words, any_of(m.records, records, random));
  append_filter_reduce(words, list_points);
  return words;
}

namespace {

void append_any_filter_command(std::vector<Word>& words, const FilterMaterial& m, Random& random) {
  switch (random.below(10)) {
    case 0:
    case 1:
      return append_filter_points(words, any_of(m.points, random.below(9), random));
    case 2:
      return append_filter_points(words, any_of(m.points, random.below(100), random));
    case 3:
      if (!random.one_in(12)) return;
      return append_filter_points(words,
                                  any_of(m.points, kMaxBlockPoints + random.below(3), random));
    case 4:
    case 5:
    case 6:
      return append_filter_records(words, any_of(m.records, random.below(12), random));
    case 7:
    case 8:
      return append_filter_reduce(words, random.one_in(2));
    default:
      if (random.one_in(3)) words.push_back(command_header(kIdentify, random.below(3)));
      // An exact core's question is unknown here.
      if (random.one_in(8)) words.push_back(command_header(kReduce, 0));
  }
}

}  // namespace

std::vector<Word> any_filter_commands(const std::vector<FilterMaterial>& all, std::size_t count,
                                      Random& random) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < count; ++i) {
    append_any_filter_command(words, all[random.below(all.size())], random);
  }
  append_filter_reduce(words, false);  // nothing stays open
  return words;
}

}  // namespace emax::test
