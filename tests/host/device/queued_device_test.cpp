#include "host/device/queued_device.h"

#include <gtest/gtest.h>

#include <atomic>

#include "sw_model/base/error.h"
#include "tests/support/board_work.h"

namespace emax {
namespace {

const test::BoardKind kWork = {"sim", 40, 120, 30, {}};

TEST(QueuedDevice, GivesTheWordsOfItsDevice) {
  const auto blocks = test::some_blocks(kWork, 51);
  const auto expected = test::undisturbed_answers(blocks);
  CppDevice plain;
  test::answers_of(plain, blocks);
  for (const std::size_t most_words :
       {std::size_t{1}, std::size_t{1000}, QueuedDevice::kMostWords}) {
    QueuedDevice queued(std::make_unique<CppDevice>(), most_words);
    EXPECT_EQ(queued.name(), "sim");
    EXPECT_EQ(test::answers_of(queued, blocks), expected);
    EXPECT_EQ(queued.counters().cycles, plain.counters().cycles);
    EXPECT_EQ(queued.counters().busy, plain.counters().busy);
  }
}

TEST(QueuedDevice, CountsWhatIsStillQueued) {
  const auto blocks = test::some_blocks(kWork, 52);
  CppDevice plain;
  QueuedDevice queued(std::make_unique<CppDevice>());
  for (const test::Block& block : blocks) {
    plain.send(block);
    queued.send(block);
  }
  EXPECT_EQ(queued.counters().cycles, plain.counters().cycles);
}

// Takes words only while its gate is open, and fails when told so.
class GatedDevice : public Device {
 public:
  struct Gate {
    std::atomic<bool> open = false, fails = false;
    std::atomic<std::size_t> taken = 0, calls = 0;
  };
  explicit GatedDevice(Gate& gate) : gate_(gate) {}
  std::string name() const override { return "gated"; }
  void send(std::span<const Word> words) override {
    ++gate_.calls;
    gate_.open.wait(false);
    if (gate_.fails) throw Error("the gate fell");
    gate_.taken += words.size();
    sim_.send(words);
  }
  void receive(std::span<Word> words) override { sim_.receive(words); }
  DeviceCounters counters() const override { return sim_.counters(); }

 private:
  Gate& gate_;
  CppDevice sim_;
};

void open(GatedDevice::Gate& gate) {
  gate.open = true;
  gate.open.notify_all();
}

TEST(QueuedDevice, HoldsNoMoreThanItsBound) {
  GatedDevice::Gate gate;
  QueuedDevice queued(std::make_unique<GatedDevice>(gate), 100);
  const auto blocks = test::some_blocks(kWork, 53);
  std::atomic<std::size_t> sent = 0;
  std::thread sender([&] {
    for (const Word word : blocks[0]) {
      queued.send({&word, 1});
      ++sent;
    }
  });
  while (sent < 100) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  // What the device is being given is not queued any more.
  EXPECT_LE(sent, 201u);
  EXPECT_EQ(gate.taken, 0u);
  open(gate);
  sender.join();
  std::vector<Word> answer;
  test::receive_answer(queued, answer);
  CppDevice plain;
  EXPECT_EQ(answer, test::answers_of(plain, {blocks[0]}));
  EXPECT_EQ(gate.taken, blocks[0].size());
}

TEST(QueuedDevice, ReturnsBeforeItsDeviceDoes) {
  GatedDevice::Gate gate;
  QueuedDevice queued(std::make_unique<GatedDevice>(gate));
  const auto blocks = test::some_blocks(kWork, 54);
  for (const test::Block& block : blocks) queued.send(block);
  EXPECT_EQ(gate.taken, 0u);
  open(gate);
  std::vector<Word> answer;
  test::receive_answer(queued, answer);
  EXPECT_FALSE(answer.empty());
}

TEST(QueuedDevice, CarriesExceptionsOver) {
  GatedDevice::Gate gate;
  gate.fails = true;
  open(gate);
  QueuedDevice queued(std::make_unique<GatedDevice>(gate));
  const std::vector<Word> question = {command_header(kIdentify, 0)};
  queued.send(question);
  std::vector<Word> answer(1);
  for (int i = 0; i < 2; ++i) {
    try {
      queued.receive(answer);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "the gate fell");
    }
  }
  EXPECT_THROW(queued.send(question), Error);
  EXPECT_NO_THROW(queued.counters());
}

TEST(QueuedDevice, RefusesAnAnswerThatNobodyAskedFor) {
  QueuedDevice queued(std::make_unique<CppDevice>());
  std::vector<Word> none(1);
  EXPECT_THROW(queued.receive(none), Error);
}

TEST(QueuedDevice, EndsWithoutWorkingOffItsQueue) {
  GatedDevice::Gate gate;
  const auto blocks = test::some_blocks(kWork, 55);
  std::size_t words = 0;
  {
    QueuedDevice queued(std::make_unique<GatedDevice>(gate));
    for (const test::Block& block : blocks) {
      queued.send(block);
      words += block.size();
    }
    while (gate.calls == 0) std::this_thread::yield();
    std::thread opener([&gate] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      open(gate);
    });
    opener.detach();
  }
  EXPECT_LT(gate.taken, words / 2);
}

}  // namespace
}  // namespace emax
