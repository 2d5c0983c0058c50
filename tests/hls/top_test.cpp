#include <gtest/gtest.h>

#include "hls/kernel/reduce.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "testbench/csim/run_top.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(Top, GivesTheModelsBits) {
  for (const test::Stimulus& s : test::all_stimuli(3)) {
    SCOPED_TRACE(s.name + ", seed 3");
    const Normalization normalization = normalization_of(s.cloud);
    auto points = normalized_points(s.cloud, normalization);
    points.resize(std::min<std::size_t>(points.size(), 100));
    const auto records = make_records(s.mesh(), normalization);
    std::vector<Word> words;
    append_load_points(words, points);
    append_records(words, records);
    append_reduce(words, true);
    const std::vector<Word> answer = run_top(words);

    const auto expected = nearest_squared_bits(points, records);
    const EmaxResult worst = worst_of(expected);
    ASSERT_EQ(answer.size(), 3 + points.size());
    EXPECT_EQ(answer[0], command_header(kReduce, static_cast<Word>(2 + points.size())));
    EXPECT_EQ(std::vector<Word>(answer.begin() + 1, answer.end() - 2), expected);
    EXPECT_EQ(answer[1 + points.size()], worst.squared_bits);
    EXPECT_EQ(answer[2 + points.size()], worst.worst_point);
  }
}

TEST(Top, IdentifiesItself) {
  const std::vector<Word> expected = {
      command_header(kIdentify, 5), kKernelVersion, kMaxBlockPoints, kRecordWords, 1, 0};
  EXPECT_EQ(run_top({command_header(kIdentify, 0)}), expected);
}

TEST(Top, AnswersMalformedCommandsWithTheReasonAndRecovers) {
  std::vector<Word> too_many = {command_header(kLoadPoints, kMaxBlockPoints + 1)};
  too_many.resize(1 + 3 * (kMaxBlockPoints + 1));
  append_reduce(too_many, false);
  EXPECT_EQ(run_top(too_many), (std::vector<Word>{command_header(kError, 1), kTooManyPoints}));

  std::vector<Word> unknown = {command_header(static_cast<Opcode>(0x55), 9)};
  append_load_points(unknown, std::vector<Vector3<float>>{{0, 0, 0}});
  append_reduce(unknown, false);
  EXPECT_EQ(run_top(unknown), (std::vector<Word>{command_header(kError, 1), kUnknownCommand}));

  std::vector<Word> nothing;
  append_reduce(nothing, false);
  EXPECT_EQ(run_top(nothing), (std::vector<Word>{command_header(kError, 1), kNoPoints}));

  EXPECT_EQ(run_top({command_header(kCounters, 0)}),
            (std::vector<Word>{command_header(kCounters, 0)}));

  std::vector<Word> good;
  append_load_points(good, std::vector<Vector3<float>>{{0, 0, 0}});
  append_reduce(good, false);
  EXPECT_EQ(run_top(good), (std::vector<Word>{command_header(kReduce, 2), kInfinityWord, 0}));

  append_reduce(good, false);  // the first ended the block
  EXPECT_EQ(run_top(good), (std::vector<Word>{command_header(kReduce, 2), kInfinityWord, 0,
                                              command_header(kError, 1), kNoPoints}));
}

}  // namespace
}  // namespace emax
