#include "host/device/xrt_device.h"

#include <gtest/gtest.h>

#include "hls/boards/alveo/movers.h"
#include "hls/kernel/emax_kernel.h"
#include "sw_model/base/error.h"
#include "sw_model/model/flushed_float.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cpp_device.h"
#include "testbench/stimuli/random.h"
#include "tests/support/messages.h"

namespace emax {
namespace {

using std::chrono::milliseconds;

// The card's own movers, in software, around the C++ core. A transfer takes some looks of the host
// to be done. Like a core with a small queue of answers, it takes no command while too many wait.
class SoftwareCard : public CardMovers {
 public:
  struct Faults {
    bool writes_never_end = false;
    bool core_is_silent = false;
  };

  explicit SoftwareCard(std::uint64_t seed, Word read_capacity = 1 << 16,
                        std::size_t answer_queue = 8)
      : random_(seed), capacity_(read_capacity), answer_queue_(answer_queue) {}

  std::string name() const override { return "software card"; }

  void start_write(std::size_t slot, std::span<const Word> words, bool reset) override {
    EXPECT_FALSE(slots_.at(slot).moving);
    slots_[slot] = {{words.begin(), words.end()}, reset, true};
    order_.push_back(slot);
    moving_most = std::max(moving_most, order_.size());
  }

  bool written(std::size_t slot, milliseconds) override {
    step();
    return !slots_.at(slot).moving;
  }

  void start_read(const AnswersDue& due, milliseconds) override {
    EXPECT_FALSE(reading_);
    reading_ = due;
    ++reads;
  }

  std::optional<MovedAnswers> read(milliseconds) override {
    step();
    if (random_.below(3) != 0) return std::nullopt;
    const AnswersDue due = reading_.value();
    reading_.reset();
    std::vector<Word> memory(kMovedHeader + capacity_, 0xdeadbeef);
    if (!faults.core_is_silent) {
      emax_from_core(memory.data(), due.answers, due.payload, capacity_, 3, answers);
    } else {
      memory[kMovedWords] = 0;
      memory[kAnswersLeft] = due.answers;
      memory[kPayloadLeft] = due.payload;
    }
    const auto begin = memory.begin() + kMovedHeader;
    return MovedAnswers{{begin, begin + memory[kMovedWords]},
                        {memory[kAnswersLeft], memory[kPayloadLeft]}};
  }

  Stream<Word> commands, answers;
  Faults faults;
  std::size_t moving_most = 0;
  int reads = 0, resets = 0;

 private:
  struct Slot {
    std::vector<Word> words;
    bool reset = false;
    bool moving = false;
  };

  // The oldest transfer ends now and then; the core computes.
  void step() {
    if (!order_.empty() && !faults.writes_never_end && answers.size() < answer_queue_ &&
        random_.below(2) == 0) {
      Slot& slot = slots_[order_.front()];
      Stream<Word> resets_stream;
      emax_to_core(slot.words.data(), static_cast<Word>(slot.words.size()), slot.reset, commands,
                   resets_stream);
      if (!resets_stream.empty()) {
        commands = {};
        missing_ = 0;
        kernel_ = {};
        ++resets;
      }
      slot.moving = false;
      order_.pop_front();
    }
    // A command whose words have not all come waits, as in hardware.
    while (!commands.empty() && answers.size() < answer_queue_) {
      if (missing_ == 0) missing_ = command_words();
      if (commands.size() < missing_) return;
      kernel_.serve(commands, answers);
      missing_ = 0;
    }
  }

  std::size_t command_words() {
    Stream<Word> copy = commands;
    return 1 + payload_words(copy.read());
  }

  Random random_;
  Word capacity_;
  std::size_t answer_queue_;
  std::array<Slot, kSlots> slots_;
  std::deque<std::size_t> order_;
  std::optional<AnswersDue> reading_;
  EmaxKernel<FlushedFloat> kernel_;
  std::size_t missing_ = 0;
};

struct Opened {
  explicit Opened(std::unique_ptr<SoftwareCard> movers)
      : card(movers.get()), device(std::move(movers), milliseconds{2000}) {}
  SoftwareCard* card;
  XrtDevice device;
};

// A block of random points and records.
std::vector<Word> random_block(Random& random, std::size_t points, std::size_t records, bool list) {
  std::vector<Vector3<float>> cloud(points);
  const auto number = [&random] { return static_cast<float>(random.uniform(-1, 1)); };
  for (auto& point : cloud) point = {number(), number(), number()};
  std::vector<Word> words;
  append_load_points(words, cloud);
  words.push_back(command_header(kRecords, static_cast<Word>(records)));
  for (std::size_t i = 0; i < records * kRecordWords; ++i) {
    words.push_back(to_word(number()));
  }
  append_reduce(words, list);
  return words;
}

TEST(XrtDevice, GivesTheWordsOfTheModelHoweverTransfersEnd) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    // Also buffers that are full in the midst of an answer.
    Opened card(std::make_unique<SoftwareCard>(seed, 1 + static_cast<Word>(random.below(50))));
    CppDevice model;
    require_compatible(card.device);
    std::deque<std::size_t> in_flight;
    const auto collect = [&] {
      std::vector<Word> expected(in_flight.front()), given(in_flight.front());
      in_flight.pop_front();
      model.receive(expected);
      card.device.receive(given);
      EXPECT_EQ(given, expected);
    };
    for (int block = 0; block < 40; ++block) {
      const std::size_t points = 1 + random.below(60);
      const bool list = random.below(2) == 0;
      const auto words = random_block(random, points, random.below(12), list);
      // A command may be cut anywhere.
      const std::size_t cut = random.below(words.size());
      for (Device* device : {static_cast<Device*>(&model), static_cast<Device*>(&card.device)}) {
        device->send(std::span(words).first(cut));
        device->send(std::span(words).subspan(cut));
      }
      in_flight.push_back(1 + kAnswerWorst + (list ? points : 0));
      if (in_flight.size() > 4) collect();
    }
    while (!in_flight.empty()) collect();
    EXPECT_EQ(card.card->resets, 1);
  }
}

TEST(XrtDevice, KeepsTwoTransfersUnderWay) {
  Random random(3);
  Opened card(std::make_unique<SoftwareCard>(3));
  // More than one buffer holds, with one answer at the end.
  const auto words = random_block(random, 8, 40000, false);
  card.device.send(words);
  std::vector<Word> answer(1 + kAnswerWorst);
  card.device.receive(answer);
  EXPECT_EQ(answer[0], command_header(kReduce, kAnswerWorst));
  EXPECT_EQ(card.card->moving_most, CardMovers::kSlots);
}

TEST(XrtDevice, AnErrorInPlaceOfAResultIsTakenAtItsOwnLength) {
  Opened card(std::make_unique<SoftwareCard>(4));
  // A result of every point was asked for, of which there is none; then an ordinary question.
  card.device.send(std::array<Word, 1>{command_header(kReduce, kReduceListsPoints)});
  EXPECT_THROW(receive_reduce(card.device, 1000, true), Error);
  EXPECT_NO_THROW(require_compatible(card.device));
}

// The answers of 64 blocks do not fit the core's queue, and the host only sends.
TEST(XrtDevice, SendingDoesNotWaitForAHostThatDoesNotRead) {
  Random random(5);
  Opened card(std::make_unique<SoftwareCard>(5));
  for (int block = 0; block < 64; ++block) {
    card.device.send(random_block(random, 100, 400, true));
  }
  for (int block = 0; block < 64; ++block) {
    std::vector<Word> answer(1 + kAnswerWorst + 100);
    card.device.receive(answer);
    EXPECT_EQ(answer[0], command_header(kReduce, kAnswerWorst + 100));
  }
}

TEST(XrtDevice, StartsAfreshAfterAHostThatWasKilled) {
  for (std::uint64_t seed = 6; seed < 16; ++seed) {
    auto card = std::make_unique<SoftwareCard>(seed);
    // Answers that nobody took, and the beginning of a command.
    for (Word i = 0; i < 5; ++i) card->answers.write(command_header(kReduce, 3));
    card->commands.write(command_header(kLoadPoints, 7));
    card->commands.write(1);
    Opened opened(std::move(card));
    EXPECT_NO_THROW(require_compatible(opened.device)) << seed;
  }
}

TEST(XrtDevice, GivesUpWithOneClearLine) {
  auto stuck = std::make_unique<SoftwareCard>(7);
  stuck->faults.writes_never_end = true;
  EXPECT_EQ(test::message_of([&] { XrtDevice(std::move(stuck), milliseconds{20}); }),
            "device software card: the card does not end its transfers; reset it with `xbutil "
            "reset`");

  auto silent = std::make_unique<SoftwareCard>(8);
  SoftwareCard& card = *silent;
  XrtDevice device(std::move(silent), milliseconds{1000});
  card.faults.core_is_silent = true;
  EXPECT_EQ(test::message_of([&] { require_compatible(device); }),
            "device software card: no answer for 1 s; reset the card with `xbutil reset` and run "
            "again");

  Opened idle(std::make_unique<SoftwareCard>(9));
  std::array<Word, 1> word;
  EXPECT_NE(test::message_of([&] { idle.device.receive(word); }).find("no command asked for"),
            std::string::npos);
}

TEST(XrtCard, SaysInOneLineWhyThereIsNone) {
#ifdef EMAX_XRT
  EXPECT_NE(
      test::message_of([] { open_xrt_card("/nowhere.xclbin"); }).find("there is no file '/nowhere"),
      std::string::npos);
  EXPECT_NE(test::message_of([] { open_xrt_card(__FILE__ "@x"); }).find("not the number of a card"),
            std::string::npos);
  // No test machine is expected to have card 4095.
  EXPECT_NE(test::message_of([] { open_xrt_card(__FILE__ "@4095"); }).find("no card answers"),
            std::string::npos);
#else
  EXPECT_NE(test::message_of([] { open_xrt_card("x"); }).find("cmake -DEMAX_XRT=ON"),
            std::string::npos);
#endif
}

// The movers alone, against what their header says.
TEST(Movers, FromCoreEndsWhateverTheCoreDoes) {
  const auto moved = [](Stream<Word>& answers, Word due, Word payload, Word capacity) {
    std::vector<Word> memory(kMovedHeader + 20, 77);
    emax_from_core(memory.data(), due, payload, capacity, 5, answers);
    for (std::size_t i = kMovedHeader + memory[kMovedWords]; i < memory.size(); ++i) {
      EXPECT_EQ(memory[i], 77u) << "a word behind the last one moved was written";
    }
    return std::array<Word, 3>{memory[kMovedWords], memory[kAnswersLeft], memory[kPayloadLeft]};
  };
  using Left = std::array<Word, 3>;
  Stream<Word> answers;
  EXPECT_EQ(moved(answers, 2, 0, 20), (Left{0, 2, 0}));  // silence
  answers.write(command_header(kError, 1));
  answers.write(3);
  answers.write(command_header(kReduce, 3));
  EXPECT_EQ(moved(answers, 1, 0, 20),
            (Left{2, 0, 0}));  // an error is two words; the next one stays
  EXPECT_EQ(moved(answers, 1, 0, 20), (Left{1, 0, 3}));  // begun, then silence
  answers.write(8);
  answers.write(9);
  EXPECT_EQ(moved(answers, 0, 3, 1), (Left{1, 0, 2}));  // full
  answers.write(10);
  answers.write(11);
  EXPECT_EQ(moved(answers, 0, 2, 20), (Left{2, 0, 0}));
  EXPECT_EQ(answers.size(), 1u);
  EXPECT_EQ(moved(answers, 0, 0, 20), (Left{0, 0, 0}));  // nothing due
  EXPECT_EQ(answers.size(), 1u);
}

}  // namespace
}  // namespace emax
