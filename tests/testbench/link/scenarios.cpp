#include <algorithm>

#include "tests/testbench/link/link_bench.h"

namespace emax {
namespace {

void expect_silence(LinkBench& bench, const std::string& after) {
  expect(bench.settle().empty(), "an answer to " + after);
}

void expect_status(const Frame& frame, std::uint8_t expected, std::uint16_t session = kSession) {
  expect(frame.version == kLinkVersion && frame.kind == FrameKind::kStatus,
         "not a status of this version");
  expect(frame.session == session, "status of another session");
  expect(frame.sequence == 0 && frame.payload.empty(), "a status with a sequence or a payload");
  expect(frame.expected == expected,
         "status expects " + std::to_string(frame.expected) + ", not " + std::to_string(expected));
}

void begin_session(LinkBench& bench) {
  expect_status(bench.ask(plain_frame(FrameKind::kReset)), 0);
}

void expect_taken(const LinkBench& bench, const std::vector<Word>& words) {
  expect(bench.taken == words, "the core took other words than were sent");
}

void expect_data(const Frame& frame, std::uint8_t sequence, const std::vector<Word>& words) {
  expect(frame.version == kLinkVersion && frame.kind == FrameKind::kData, "not a data frame");
  expect(frame.session == kSession, "a data frame of another session");
  expect(frame.sequence == sequence, "a data frame with another sequence");
  expect(frame.payload == words, "a data frame with other words");
}

std::vector<Word> part(const std::vector<Word>& words, std::size_t begin, std::size_t end) {
  return {words.begin() + static_cast<std::ptrdiff_t>(begin),
          words.begin() + static_cast<std::ptrdiff_t>(std::min(end, words.size()))};
}

void append(std::vector<Word>& words, const std::vector<Word>& more) {
  words.insert(words.end(), more.begin(), more.end());
}

void give(LinkBench& bench, const std::vector<Word>& words) {
  bench.answers.insert(bench.answers.end(), words.begin(), words.end());
}

void reset_begins_a_session(LinkBench& bench) {
  const Frame status = bench.ask(plain_frame(FrameKind::kReset));
  expect_status(status, 0);
  expect(status.credit == kRoom, "the whole room is not promised");
  expect(bench.resets_of_core == 1 && bench.longest_reset >= 16, "no reset of the core");
  expect(bench.words_in_reset == 0, "words pass while the core is reset");
  expect_status(bench.ask(plain_frame(FrameKind::kPoll)), 0);
}

void unknown_sessions_are_lost(LinkBench& bench) {
  const auto lost = [&](const Frame& frame) {
    const Frame answer = bench.ask(frame);
    expect(answer.kind == FrameKind::kLost, "not told that the session is lost");
    expect(answer.session == frame.session, "another session is told lost");
  };
  lost(plain_frame(FrameKind::kPoll));
  lost(plain_frame(FrameKind::kPoll, 0, 0));  // what a register may hold after power-up
  lost(data_frame(0, numbered_words(3)));
  begin_session(bench);
  Frame other = data_frame(0, numbered_words(3));
  other.session = kSession + 1;
  lost(other);
  other.session = static_cast<std::uint16_t>(kSession ^ 0x100);
  lost(other);
  lost(plain_frame(FrameKind::kPoll, 0, kSession + 1));
  bench.send(plain_frame(FrameKind::kStatus, 0, kSession + 1));
  expect_silence(bench, "a status of another session");
  expect(bench.taken.empty(), "words of another session");
  give(bench, answer_of(3));
  bench.settle();
  bench.send(plain_frame(FrameKind::kStatus, 1, kSession + 1));
  bench.settle();
  expect_data(bench.ask(plain_frame(FrameKind::kPoll)), 0, answer_of(3));
}

void other_versions_hear_this_one(LinkBench& bench) {
  begin_session(bench);
  Frame foreign = data_frame(0, numbered_words(3));
  foreign.version = kLinkVersion - 1;
  bench.send(foreign);
  expect_silence(bench, "a data frame of another version");
  foreign = plain_frame(FrameKind::kPoll);
  foreign.version = kLinkVersion + 1;
  bench.send(foreign);
  expect_silence(bench, "a poll of another version");
  foreign = plain_frame(FrameKind::kReset, 0, 77);
  foreign.version = kLinkVersion - 1;
  const Frame status = bench.ask(foreign);
  expect(status.version == kLinkVersion && status.kind == FrameKind::kStatus,
         "not told the version");
  expect(status.session == 77, "not told the version in the session that asked");
  expect(bench.resets_of_core == 1, "reset by another version");
  expect_status(bench.ask(data_frame(0, numbered_words(3))), 1);
  expect_taken(bench, numbered_words(3));
}

void kinds_of_the_device_are_ignored(LinkBench& bench) {
  begin_session(bench);
  for (const int kind : {0, 3, 5, 6, 255}) {
    bench.send(plain_frame(static_cast<FrameKind>(kind)));
    expect_silence(bench, "a frame of kind " + std::to_string(kind));
  }
  bench.send(data_frame(0, {}));
  expect_silence(bench, "a data frame without words");
  expect_status(bench.ask(plain_frame(FrameKind::kPoll)), 0);
}

void words_pass_in_order(LinkBench& bench) {
  begin_session(bench);
  std::vector<Word> all;
  std::uint8_t sequence = 0;
  for (const std::size_t count : {1, 256, 2, 255, 17, 256, 256, 100}) {
    const auto words = numbered_words(count, static_cast<Word>(0x4de50000u + all.size()));
    append(all, words);
    expect_status(bench.ask(data_frame(sequence, words)), static_cast<std::uint8_t>(sequence + 1));
    ++sequence;
  }
  expect_taken(bench, all);
}

void any_damage_is_seen(LinkBench& bench) {
  begin_session(bench);
  const std::vector<Word> words = numbered_words(9);
  const std::vector<std::uint8_t> whole = encode(data_frame(0, words));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[i] ^= static_cast<std::uint8_t>(1u << bench.random.below(8));
    bench.send(bytes);
    bench.settle();
    bench.clock(kGapClocks + 10);
    bench.settle();
    expect(bench.taken.empty(), "words of a frame with a wrong byte " + std::to_string(i));
  }
  expect_status(bench.ask(plain_frame(FrameKind::kPoll)), 0);
  expect_status(bench.ask(data_frame(0, words)), 1);
  expect_taken(bench, words);
}

// Directly after the wrong one: nothing of it may count among the words of the next.
void a_wrong_frame_leaves_nothing(LinkBench& bench) {
  begin_session(bench);
  std::vector<Word> all;
  for (std::uint8_t sequence = 0; sequence < 6; ++sequence) {
    std::vector<std::uint8_t> wrong = encode(data_frame(sequence, numbered_words(20, 0xbad00000u)));
    wrong.back() ^= 0x80;
    bench.send(wrong);
    const auto words = numbered_words(5 + sequence, static_cast<Word>(all.size()));
    append(all, words);
    expect_status(bench.ask(data_frame(sequence, words)), static_cast<std::uint8_t>(sequence + 1));
    expect_taken(bench, all);
  }
}

void impossible_lengths_end_at_the_header(LinkBench& bench) {
  begin_session(bench);
  std::uint8_t sequence = 0;
  std::vector<Word> all;
  for (const std::uint32_t length : {257u, 512u, 0x1001u, 0xffffu}) {
    std::vector<std::uint8_t> header = encode(plain_frame(FrameKind::kData));
    header.resize(kFrameHeaderBytes);
    header[8] = static_cast<std::uint8_t>(length);
    header[9] = static_cast<std::uint8_t>(length >> 8);
    bench.send(header);
    append(all, numbered_words(4, length));
    expect_status(bench.ask(data_frame(sequence, numbered_words(4, length))),
                  static_cast<std::uint8_t>(sequence + 1));
    ++sequence;
  }
  expect_taken(bench, all);
}

void a_broken_off_frame_is_forgotten(LinkBench& bench) {
  begin_session(bench);
  const std::vector<std::uint8_t> whole = encode(data_frame(0, numbered_words(40)));
  std::uint8_t sequence = 0;
  std::vector<Word> all;
  for (const std::size_t kept : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{12},
                                 std::size_t{50}, whole.size() - 1}) {
    bench.send(std::span(whole).first(kept));
    bench.settle();
    bench.clock(kGapClocks + 10);
    append(all, numbered_words(3, static_cast<Word>(kept)));
    expect_status(bench.ask(data_frame(sequence, numbered_words(3, static_cast<Word>(kept)))),
                  static_cast<std::uint8_t>(sequence + 1));
    ++sequence;
  }
  expect_taken(bench, all);
}

void a_pause_within_a_frame_is_borne(LinkBench& bench) {
  begin_session(bench);
  const std::vector<std::uint8_t> whole = encode(data_frame(0, numbered_words(40)));
  for (std::size_t begin = 0; begin < whole.size(); begin += 31) {
    bench.send(std::span(whole).subspan(begin, std::min<std::size_t>(31, whole.size() - begin)));
    while (bench.sending()) bench.clock();
    bench.clock(kGapClocks - 500);
  }
  bench.settle();
  expect_taken(bench, numbered_words(40));
}

void frames_count_in_their_order(LinkBench& bench) {
  begin_session(bench);
  const auto first = numbered_words(10, 100), second = numbered_words(11, 200);
  expect_status(bench.ask(data_frame(1, second)), 0);
  expect_status(bench.ask(data_frame(255, second)), 0);
  expect_status(bench.ask(data_frame(0, first)), 1);
  expect_status(bench.ask(data_frame(0, first)), 1);
  expect_status(bench.ask(data_frame(2, first)), 1);
  expect_status(bench.ask(data_frame(1, second)), 2);
  std::vector<Word> all = first;
  append(all, second);
  expect_taken(bench, all);
}

void sequences_wrap_around(LinkBench& bench) {
  begin_session(bench);
  bench.echoes = true;
  for (unsigned i = 0; i < 600; ++i) {
    const auto sequence = static_cast<std::uint8_t>(i);
    const std::vector<Frame> frames = [&] {
      bench.send(data_frame(sequence, {~(i << 24)}, sequence));
      return bench.settle();
    }();
    expect(!frames.empty(), "no answer");
    expect_data(frames.back(), sequence, {i << 24});  // an answer without words
    expect(frames.back().expected == static_cast<std::uint8_t>(i + 1), "the word has not arrived");
  }
  expect(bench.taken.size() == 600, "the core took more words, or fewer, than were sent");
}

void credit_is_kept(LinkBench& bench) {
  begin_session(bench);
  bench.takes = false;
  std::uint8_t sequence = 0;
  std::vector<Word> all;
  Frame status = bench.ask(plain_frame(FrameKind::kPoll));
  // All that is promised is taken.
  while (status.credit > 0) {
    const std::size_t count = std::min<std::size_t>(status.credit, 1 + bench.random.below(256));
    const auto words = numbered_words(count, static_cast<Word>(all.size()));
    append(all, words);
    const Frame next = bench.ask(data_frame(sequence, words));
    expect_status(next, ++sequence);
    expect(next.credit + count >= status.credit, "a promise is taken back");
    status = next;
    expect(all.size() < 2 * kRoom, "promises without end");
  }
  expect(all.size() >= kRoom, "less than the room is promised");
  expect_status(bench.ask(data_frame(sequence, {7})), sequence);
  bench.takes = true;
  const std::vector<Frame> frames = bench.settle();
  expect_taken(bench, all);
  expect(frames.size() == 1, "not told once that there is room again");
  expect_status(frames[0], sequence);
  expect(frames[0].credit >= kRoom / 2, "told of room before half of it is there");
  expect_status(bench.ask(data_frame(sequence, {7})), static_cast<std::uint8_t>(sequence + 1));
}

void an_answer_stays_until_acknowledged(LinkBench& bench) {
  begin_session(bench);
  const std::vector<Word> words = answer_of(700);
  give(bench, words);
  std::vector<Frame> frames = bench.settle();
  expect(frames.size() == 1, "not one data frame under way");
  expect_data(frames[0], 0, part(words, 0, 256));
  // Repeated on a poll, and as the answer to data, taken or not.
  expect_data(bench.ask(plain_frame(FrameKind::kPoll)), 0, part(words, 0, 256));
  expect_data(bench.ask(plain_frame(FrameKind::kPoll)), 0, part(words, 0, 256));
  const Frame repeated = bench.ask(data_frame(0, {1}));
  expect_data(repeated, 0, part(words, 0, 256));
  expect(repeated.expected == 1, "a data frame that does not acknowledge");
  expect_data(bench.ask(data_frame(0, {1})), 0, part(words, 0, 256));
  // What does not acknowledge it.
  for (const int expected : {0, 2, 255}) {
    bench.send(plain_frame(FrameKind::kStatus, static_cast<std::uint8_t>(expected)));
    expect_silence(bench, "a status");
  }
  expect_data(bench.ask(plain_frame(FrameKind::kPoll)), 0, part(words, 0, 256));
  // By a status, by a data frame, by a poll.
  expect_data(bench.ask(plain_frame(FrameKind::kStatus, 1)), 1, part(words, 256, 512));
  bench.send(data_frame(1, {2}, 2));
  frames = bench.settle();
  expect(!frames.empty() && frames.size() <= 2, "not answered by the next data frame");
  expect_data(frames.back(), 2, part(words, 512, 700));
  expect_status(bench.ask(plain_frame(FrameKind::kPoll, 3)), 2);
  expect_taken(bench, {1, 2});
}

// After a pause; also where an answer takes several frames.
void frames_end_with_answers(LinkBench& bench) {
  begin_session(bench);
  const std::vector<Word> five = answer_of(5), many = answer_of(300);
  give(bench, part(five, 0, 1));
  expect_silence(bench, "a header");
  give(bench, part(five, 1, 4));
  expect_silence(bench, "the beginning of an answer");
  give(bench, part(five, 4, 5));
  give(bench, part(many, 0, 1));
  expect_silence(bench, "an answer and the header of the next");
  std::vector<Word> all = five;
  append(all, many);
  give(bench, part(many, 1, 299));
  std::vector<Frame> frames = bench.settle();
  expect(frames.size() == 1, "not one full frame");
  expect_data(frames[0], 0, part(all, 0, 256));
  bench.send(plain_frame(FrameKind::kStatus, 1));
  expect_silence(bench, "all but the last word of an answer");
  give(bench, part(many, 299, 300));
  frames = bench.settle();
  expect(frames.size() == 1, "not one frame with the end of an answer");
  expect_data(frames[0], 1, part(all, 256, 305));
  bench.send(plain_frame(FrameKind::kStatus, 2));
  expect_silence(bench, "an acknowledgement");
  give(bench, answer_of(1));
  frames = bench.settle();
  expect(frames.size() == 1, "not one frame with an answer without words");
  expect_data(frames[0], 2, answer_of(1));
}

void a_reset_forgets_everything(LinkBench& bench) {
  begin_session(bench);
  bench.takes = false;
  expect_status(bench.ask(data_frame(0, numbered_words(100))), 1);
  give(bench, answer_of(3));
  expect(bench.settle().size() == 1, "no answer");
  give(bench, part(answer_of(400), 0, 300));
  bench.settle();
  // In the middle of a frame that is sent, and as the next session.
  bench.send(plain_frame(FrameKind::kPoll));
  bench.clock(60 * 8);
  bench.send(plain_frame(FrameKind::kReset, 0, kSession + 5));
  bench.settle();
  const Frame polled = bench.ask(plain_frame(FrameKind::kPoll, 0, kSession + 5));
  expect_status(polled, 0, kSession + 5);
  expect(polled.credit == kRoom, "words of before the reset take room");
  expect(bench.resets_of_core == 2, "the core was not reset");
  bench.takes = true;
  bench.settle();
  expect(bench.taken.empty(), "words of before the reset");
  expect(bench.words_in_reset == 0, "words pass while the core is reset");
  Frame data = data_frame(0, numbered_words(5));
  data.session = kSession + 5;
  expect_status(bench.ask(data), 1, kSession + 5);
  expect_taken(bench, numbered_words(5));
  give(bench, answer_of(2));
  const std::vector<Frame> frames = bench.settle();
  expect(frames.size() == 1 && frames[0].sequence == 0 && frames[0].payload == answer_of(2),
         "not the first answer of the new session");
}

void a_reset_while_an_answer_is_sent(LinkBench& bench) {
  begin_session(bench);
  give(bench, answer_of(200));
  bench.clock(400);  // the data frame is on its way
  bench.send(plain_frame(FrameKind::kReset, 0, kSession + 5));
  const std::vector<Frame> frames = bench.settle();
  expect(!frames.empty(), "no answer to a reset");
  expect_status(frames.back(), 0, kSession + 5);
  for (const Frame& frame : frames)
    expect(frame.kind != FrameKind::kData || frame.session == kSession,
           "an old answer in the new session");
}

void garbage_is_ignored(LinkBench& bench) {
  std::vector<std::uint8_t> garbage(3000);
  for (std::uint8_t& byte : garbage) {
    const std::uint32_t choice = bench.random.below(4);
    byte = choice == 0 ? 0x4d : choice == 1 ? 0xe5 : static_cast<std::uint8_t>(bench.random.word());
  }
  bench.send(garbage);
  expect_silence(bench, "garbage");
  bench.clock(kGapClocks + 10);
  // Sync bytes that nearly came do not hide those that come.
  bench.send(std::vector<std::uint8_t>{0x4d, 0x4d, 0x00, 0xe5, 0x4d});
  begin_session(bench);
  bench.send(garbage);
  expect_silence(bench, "garbage");
  bench.clock(kGapClocks + 10);
  expect_status(bench.ask(data_frame(0, numbered_words(3))), 1);
  expect_taken(bench, numbered_words(3));
}

void echo_without_faults(LinkBench& bench) { pass_words_through_faults(bench, 6000, 0); }
void echo_with_idle_cycles(LinkBench& bench) {
  bench.idle = 3;
  pass_words_through_faults(bench, 4000, 0);
}
void echo_with_faults(LinkBench& bench) { pass_words_through_faults(bench, 6000, 100); }
void echo_with_faults_and_idle_cycles(LinkBench& bench) {
  bench.idle = 7;
  pass_words_through_faults(bench, 3000, 200);
}

}  // namespace

const std::vector<Scenario>& link_scenarios() {
#define EMAX_SCENARIO(name) \
  { #name, name }
  static const std::vector<Scenario> scenarios = {
      EMAX_SCENARIO(reset_begins_a_session),
      EMAX_SCENARIO(unknown_sessions_are_lost),
      EMAX_SCENARIO(other_versions_hear_this_one),
      EMAX_SCENARIO(kinds_of_the_device_are_ignored),
      EMAX_SCENARIO(words_pass_in_order),
      EMAX_SCENARIO(any_damage_is_seen),
      EMAX_SCENARIO(a_wrong_frame_leaves_nothing),
      EMAX_SCENARIO(impossible_lengths_end_at_the_header),
      EMAX_SCENARIO(a_broken_off_frame_is_forgotten),
      EMAX_SCENARIO(a_pause_within_a_frame_is_borne),
      EMAX_SCENARIO(frames_count_in_their_order),
      EMAX_SCENARIO(sequences_wrap_around),
      EMAX_SCENARIO(credit_is_kept),
      EMAX_SCENARIO(an_answer_stays_until_acknowledged),
      EMAX_SCENARIO(frames_end_with_answers),
      EMAX_SCENARIO(a_reset_forgets_everything),
      EMAX_SCENARIO(a_reset_while_an_answer_is_sent),
      EMAX_SCENARIO(garbage_is_ignored),
      EMAX_SCENARIO(echo_without_faults),
      EMAX_SCENARIO(echo_with_idle_cycles),
      EMAX_SCENARIO(echo_with_faults),
      EMAX_SCENARIO(echo_with_faults_and_idle_cycles),
  };
#undef EMAX_SCENARIO
  return scenarios;
}

}  // namespace emax
