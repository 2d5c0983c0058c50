#include "sw_model/protocol/cpp_device.h"

#include <gtest/gtest.h>

#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(CppDevice, GivesTheModelsBitsForAnyCutOfTheWords) {
  test::Random random(9);
  for (const test::Stimulus& s : test::all_stimuli(21)) {
    SCOPED_TRACE(s.name + ", seed 21");
    const Normalization normalization = normalization_of(s.cloud);
    auto points = normalized_points(s.cloud, normalization);
    points.resize(std::min<std::size_t>(points.size(), 80));
    const auto records = make_records(s.mesh(), normalization);
    std::vector<Word> words;
    append_load_points(words, points);
    append_records(words, records);
    append_reduce(words, true);

    CppDevice device;
    require_compatible(device);
    for (std::size_t sent = 0; sent < words.size();) {
      const std::size_t count = std::min<std::size_t>(random.below(40), words.size() - sent);
      device.send(std::span(words).subspan(sent, count));
      sent += count;
    }
    const ReduceAnswer answer = receive_reduce(device, points.size(), true);
    const auto expected = nearest_squared_bits(points, records);
    EXPECT_EQ(answer.points_squared_bits, expected);
    EXPECT_EQ(answer.squared_bits, worst_of(expected).squared_bits);
    EXPECT_EQ(answer.worst, worst_of(expected).worst_point);
  }
}

TEST(CppDevice, ErrorsOfTheDeviceNameThemselves) {
  CppDevice device;
  std::vector<Word> words;
  append_reduce(words, false);
  device.send(words);
  EXPECT_THROW(
      {
        try {
          receive_reduce(device, 1, false);
        } catch (const Error& error) {
          EXPECT_NE(std::string(error.what()).find("before any points"), std::string::npos);
          throw;
        }
      },
      Error);
  std::vector<Word> none(1);
  EXPECT_THROW(device.receive(none), Error);
}

// A device that answers every question with the given words.
class ScriptedDevice : public Device {
 public:
  explicit ScriptedDevice(std::vector<Word> script) : script_(std::move(script)) {}
  std::string name() const override { return "scripted"; }
  void send(std::span<const Word>) override {}
  void receive(std::span<Word> words) override {
    for (Word& word : words) word = script_.at(next_++);
  }
  DeviceCounters counters() const override { return {}; }

 private:
  std::vector<Word> script_;
  std::size_t next_ = 0;
};

TEST(Commands, RefuseAnAnswerThatIsNotTheirs) {
  ScriptedDevice out_of_step({command_header(kReduce, 7)});
  EXPECT_THROW(receive_reduce(out_of_step, 4, false), Error);
  ScriptedDevice outside({command_header(kReduce, 2), 5, 4});
  EXPECT_THROW(receive_reduce(outside, 4, false), Error);
  ScriptedDevice right({command_header(kReduce, 2), 5, 3});
  EXPECT_EQ(receive_reduce(right, 4, false).worst, 3u);
  ScriptedDevice other_version({command_header(kIdentify, 5), kKernelVersion + 1, 1024, 20, 1, 0});
  EXPECT_THROW(require_compatible(other_version), Error);
}

TEST(Commands, AskForTheCyclesOfADevice) {
  ScriptedDevice counting({command_header(kCounters, 6), 1, 2, 3, 0, 0xffffffff, 4});
  DeviceCounters counters;
  counters.resends = 7;
  ask_cycles(counting, counters);
  EXPECT_EQ(counters.busy, 0x200000001u);
  EXPECT_EQ(counters.stalled, 3u);
  EXPECT_EQ(counters.idle, 0x4ffffffffu);
  EXPECT_EQ(counters.cycles, 0x200000001u + 3 + 0x4ffffffffu);
  EXPECT_EQ(counters.resends, 7u);

  ScriptedDevice not_counting({command_header(kCounters, 0)});
  DeviceCounters modelled;
  modelled.cycles = 5;
  ask_cycles(not_counting, modelled);
  EXPECT_EQ(modelled.cycles, 5u);
  EXPECT_EQ(modelled.busy, std::nullopt);

  for (const Word header : {command_header(kReduce, 6), command_header(kCounters, 5)}) {
    ScriptedDevice out_of_step({header, 0, 0, 0, 0, 0, 0});
    EXPECT_THROW(ask_cycles(out_of_step, counters), Error) << header;
  }
}

TEST(Commands, AreFoundInAnyCutOfTheWords) {
  test::Random random(11);
  const std::vector<Vector3<float>> points(5);
  const std::vector<TriangleRecord<float>> records(3);
  std::vector<Word> words;
  std::vector<std::size_t> beginnings;
  for (int i = 0; i < 200; ++i) {
    beginnings.push_back(words.size());
    switch (random.below(4)) {
      case 0:
        append_load_points(words, std::span(points).first(random.below(6)));
        break;
      case 1:
        append_records(words, std::span(records).first(random.below(4)));
        break;
      case 2:
        append_reduce(words, true);
        break;
      default:
        words.push_back(command_header(kIdentify, 0));
    }
  }
  beginnings.push_back(words.size());

  CommandCursor cursor;
  std::size_t taken = 0, command = 0;
  while (taken < words.size()) {
    std::span<const Word> cut = std::span(words).subspan(
        taken, std::min<std::size_t>(1 + random.below(30), words.size() - taken));
    while (!cut.empty()) {
      const CommandCursor::Part part = cursor.take(cut);
      ASSERT_EQ(part.words.data(), &words[taken]);
      EXPECT_EQ(part.header, words[beginnings[command]]);
      EXPECT_EQ(part.begins, taken == beginnings[command]);
      taken += part.words.size();
      ASSERT_LE(taken, beginnings[command + 1]);
      EXPECT_EQ(part.ends, taken == beginnings[command + 1]);
      if (part.ends) ++command;
    }
  }
  EXPECT_EQ(command, beginnings.size() - 1);
}

TEST(CycleModel, CountsOnePairACyclePerElement) {
  CycleModel one(1), two(2);
  for (CycleModel* model : {&one, &two}) {
    model->load_points(1000);
    model->stream_records(500);
    model->reduce(false);
  }
  EXPECT_EQ(one.busy(), 500000u);
  EXPECT_EQ(two.busy(), 250000u);
  EXPECT_EQ(one.stalled(), one.cycles() - one.busy());
  EXPECT_GT(one.cycles(), 500000u + 3000u);
  EXPECT_LT(static_cast<double>(one.cycles()), 1.01 * (500000 + 3000 + 1000));
}

TEST(CycleModel, StallsWhereRecordsArriveTooSlowly) {
  CycleModel model(4);
  model.load_points(16);
  model.stream_records(10);
  model.reduce(false);
  EXPECT_EQ(model.busy(), 50u);  // a pass has five rows at least
  EXPECT_GT(model.stalled(), 150u);
}

TEST(CycleModel, PredictsTheSlowerOfComputingAndLink) {
  const BoardModel& board = board_model("ulx3s");
  EXPECT_DOUBLE_EQ(predicted_seconds(board, 180000000, 10, 10), 2.0);
  EXPECT_DOUBLE_EQ(predicted_seconds(board, 1, 75000, 10), 1.0);
  EXPECT_THROW(board_model("toaster"), Error);
}

}  // namespace
}  // namespace emax
