#include "host/device/command_log.h"

#include <gtest/gtest.h>

#include "sw_model/protocol/commands.h"

namespace emax {
namespace {

using Words = std::vector<Word>;

const Word kAsk = command_header(kIdentify, 0);
const Word kAskResult = command_header(kReduce, 0);

Words block(Word value, bool question_inside = false) {
  Words words = {command_header(kLoadPoints, 1), value, value, value};
  if (question_inside) words.push_back(kAsk);
  words.push_back(kAskResult);
  return words;
}
// What a device answers to a Reduce, or to an Identify, in these tests.
Words result(Word value) { return {command_header(kReduce, 2), value, 0}; }
Words identity() { return {command_header(kIdentify, 1), 1}; }

Words given(CommandLog& log) {
  Words words(log.ready());
  log.give(words);
  return words;
}

Words joined(const std::vector<Words>& parts) {
  Words all;
  for (const Words& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(CommandLog, KeepsWhatIsNotAnswered) {
  CommandLog log;
  const Words words = joined({{kAsk}, block(7), block(8)});
  for (const Word word : words) log.append({&word, 1});
  EXPECT_EQ(log.due(), 3u);
  EXPECT_EQ(log.take(3), joined({{kAsk}, {words[1], 7}}));
  EXPECT_EQ(log.take(100), Words(words.begin() + 3, words.end()));
  EXPECT_EQ(log.unsent(), 0u);

  // The first answer, and half of the second.
  EXPECT_TRUE(log.add_answers(joined({identity(), {result(5)[0]}})));
  EXPECT_EQ(given(log), identity());
  log.rewind();
  EXPECT_EQ(log.take(100), joined({block(7), block(8)}));
  EXPECT_TRUE(log.add_answers(joined({result(5), result(6)})));
  EXPECT_EQ(given(log), joined({result(5), result(6)}));
  EXPECT_EQ(log.due(), 0u);
  log.rewind();
  EXPECT_EQ(log.unsent(), 0u);
}

TEST(CommandLog, AnswersAQuestionInsideABlockOnce) {
  CommandLog log;
  log.append(block(7, true));
  log.take(100);
  EXPECT_TRUE(log.add_answers(identity()));
  EXPECT_EQ(given(log), identity());
  log.rewind();
  EXPECT_EQ(log.take(100), block(7, true));
  EXPECT_TRUE(log.add_answers(identity()));
  EXPECT_EQ(log.ready(), 0u);
  EXPECT_TRUE(log.add_answers(result(5)));
  EXPECT_EQ(given(log), result(5));
}

TEST(CommandLog, ACommandThatIsNotWholeYetIsSentAgainToo) {
  CommandLog log;
  const Words words = block(7);
  log.append(std::span(words).first(2));
  EXPECT_EQ(log.take(100).size(), 2u);
  log.rewind();
  log.append(std::span(words).subspan(2));
  EXPECT_EQ(log.take(100), words);
}

// Words that units which are gone have stored, the last of each address, before the units that
// stay.
TEST(CommandLog, StoresAgainWhatWasStored) {
  CommandLog log;
  const Words recall = {command_header(kRecall, 2), command_header(kFilterPoints, 1),
                        store_piece(5, 2)};
  const Words ask = {command_header(kFilterReduce, 0)}, answer = {command_header(kFilterReduce, 0)};
  log.append(joined({{command_header(kStore, 4), 5, 1, 2, 3}, recall, ask}));
  log.append(joined({{command_header(kStore, 2), 6, 9}, {command_header(kStore, 2), 20, 4}, ask}));
  const Words third = joined({{command_header(kStore, 2), 5, 8}, recall, ask});
  log.append(third);
  log.take(100);
  EXPECT_TRUE(log.add_answers(joined({answer, answer})));
  log.rewind();
  const Words restore = {command_header(kStore, 4), 5, 1, 9, 3, command_header(kStore, 2), 20, 4};
  EXPECT_EQ(log.unsent(), restore.size() + third.size());
  EXPECT_EQ(log.take(3), (Words{restore[0], restore[1], restore[2]}));
  log.rewind();
  EXPECT_EQ(log.take(100), joined({restore, third}));
  EXPECT_EQ(log.unsent(), 0u);
  EXPECT_TRUE(log.add_answers(answer));
  EXPECT_EQ(given(log), joined({answer, answer, answer}));
}

TEST(CommandLog, RefusesAnAnswerThatNothingAskedFor) {
  CommandLog log;
  EXPECT_FALSE(log.add_answers(identity()));
  CommandLog unsent;
  unsent.append(block(7));
  unsent.take(4);
  EXPECT_FALSE(unsent.add_answers(result(5)));
  CommandLog twice;
  twice.append(block(7));
  twice.take(5);
  EXPECT_FALSE(twice.add_answers(joined({result(5), result(5)})));
}

}  // namespace
}  // namespace emax
