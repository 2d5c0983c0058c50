// The filtering core's words, and its device in C++ beside the filter of the model.
#include <gtest/gtest.h>

#include <algorithm>

#include "sw_model/base/error.h"
#include "sw_model/model/fixed_filter.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/cpp_device.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

FilterNumber any_number(test::Random& random) {
  return FilterNumber::from_raw(static_cast<std::int64_t>(random.below(1u << 18)) - (1 << 17));
}

TEST(FilterWords, HoldEveryNumber) {
  test::Random random(91);
  for (int i = 0; i < 2000; ++i) {
    const FilterNumber x = any_number(random), y = any_number(random), z = any_number(random);
    Word point[kFilterPointWords] = {};
    pack_filter_point({x, y, z}, point);
    const Vector3<FilterNumber> same = unpacked_filter_point(point);
    ASSERT_TRUE(same.x == x && same.y == y && same.z == z) << "seed 91, " << i;
    TriangleRecord<FilterNumber> record{};
    for_each_scalar([&](FilterNumber& scalar) { scalar = any_number(random); }, record);
    record.tag = random.below(2) == 0 ? kSegmentFlag : 0;
    Word words[kFilterRecordWords] = {};
    pack_filter_record(record, words);
    TriangleRecord<FilterNumber> back = unpacked_filter_record(words);
    int differing = 0;
    for_each_scalar([&](const FilterNumber& a, const FilterNumber& b) { differing += a != b; },
                    record, back);
    ASSERT_EQ(differing, 0) << "seed 91, " << i;
    ASSERT_EQ(back.tag, record.tag);
  }
}

TEST(FilterWords, StandWhereTheHardwareReadsThem) {
  const FilterNumber minus = FilterNumber::from_raw(-1), one = FilterNumber::from_raw(1);
  Word point[kFilterPointWords] = {};
  pack_filter_point({minus, one, FilterNumber::from_raw(0x15555)}, point);
  EXPECT_EQ(point[0], 0x0007ffffu);  // x at bit 0, y at bit 18
  EXPECT_EQ(point[1], 0x00155550u);  // z at bit 36
  TriangleRecord<FilterNumber> record{};
  record.edge23.length = minus;
  record.tag = kSegmentFlag | 5;
  Word words[kFilterRecordWords] = {};
  pack_filter_record(record, words);
  EXPECT_EQ(words[10], 0x007ffff0u);  // the last number at bit 324, the flag at bit 342
}

// The model's least squares of the points over the records that fit, below 1.
std::vector<Word> least_of_model(const std::vector<Vector3<FilterNumber>>& points,
                                 const std::vector<TriangleRecord<FilterNumber>>& records) {
  std::vector<Word> least;
  for (const auto& p : points) {
    std::int64_t of_point = kFilterFar;
    for (const auto& record : records) {
      of_point = std::min<std::int64_t>(of_point, filter_squared_distance<18>(p, record).raw());
    }
    least.push_back(static_cast<Word>(of_point));
  }
  return least;
}

TEST(CppFilter, GivesTheModelsLeastSquares) {
  long far = 0, near = 0;
  for (const test::Stimulus& s : test::all_stimuli(92)) {
    SCOPED_TRACE(s.name + ", seed 92");
    const Normalization normalization = normalization_of(s.cloud);
    const auto exact_points = normalized_points(s.cloud, normalization);
    const auto exact_records = make_records(s.mesh(), normalization);
    const int exponent = filter_exponent(exact_points, exact_records, 18);
    std::vector<Vector3<FilterNumber>> points;
    for (std::size_t i = 0; i < std::min<std::size_t>(exact_points.size(), 200); ++i) {
      points.push_back(filter_point<18>(exact_points[i], exponent));
    }
    std::vector<TriangleRecord<FilterNumber>> records;
    for (const auto& record : exact_records) {
      if (const auto fixed = filter_record<18>(record, exponent)) records.push_back(*fixed);
    }
    CppFilter device;
    require_filter(device);
    std::vector<Word> words;
    append_filter_points(words, points);
    append_filter_records(words, records);
    append_filter_reduce(words, true);
    device.send(words);
    const ReduceAnswer answer = receive_reduce(device, points.size(), true, kFilterReduce);
    const std::vector<Word> expected = least_of_model(points, records);
    EXPECT_EQ(answer.points_squared_bits, expected);
    EXPECT_EQ(answer.squared_bits, *std::ranges::max_element(expected));
    EXPECT_EQ(expected[answer.worst], answer.squared_bits);
    for (const Word word : expected) ++(word == kFilterFar ? far : near);
  }
  EXPECT_GT(near, 500);
  EXPECT_GT(far, 0);
}

TEST(CppFilter, RefusesTheCommandsOfAnExactCore) {
  CppFilter device;
  EXPECT_THROW(require_compatible(device), Error);
  std::vector<Word> words;
  append_reduce(words, false);
  append_filter_reduce(words, false);
  device.send(words);
  std::vector<Word> answer(2);
  device.receive(answer);
  EXPECT_EQ(answer, (std::vector<Word>{command_header(kError, 1), kUnknownCommand}));
}

}  // namespace
}  // namespace emax
