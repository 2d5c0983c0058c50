#include "testbench/rtl_device.h"

#include <gtest/gtest.h>

#include "sw_model/commands.h"
#include "sw_model/cpp_device.h"
#include "sw_model/error.h"
#include "sw_model/triangle_frame.h"
#include "testbench/stimuli.h"

namespace emax {
namespace {

struct Material {
  std::vector<Vector3<float>> points;
  std::vector<TriangleRecord<float>> records;
};

std::vector<Material> materials(std::uint64_t seed) {
  std::vector<Material> all;
  for (const test::Stimulus& s : test::all_stimuli(seed)) {
    const Normalization normalization = normalization_of(s.cloud);
    all.push_back(
        {normalized_points(s.cloud, normalization), make_records(s.mesh(), normalization)});
  }
  return all;
}

template <class Value>
std::vector<Value> any_of(const std::vector<Value>& values, std::size_t count, Random& random) {
  std::vector<Value> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(values[random.below(static_cast<std::uint32_t>(values.size()))]);
  }
  return chosen;
}

// Commands in any order: blocks of all sizes, records before points, reductions twice or in the
// middle, too many points, unknown opcodes.
std::vector<Word> random_command(const std::vector<Material>& all, Random& random) {
  const Material& m = all[random.below(static_cast<std::uint32_t>(all.size()))];
  std::vector<Word> words;
  switch (random.below(10)) {
    case 0:
    case 1:
      append_load_points(words, any_of(m.points, random.below(6), random));
      break;
    case 2:
      append_load_points(words, any_of(m.points, random.below(100), random));
      break;
    case 3:
      if (random.one_in(12)) {
        append_load_points(words, any_of(m.points, kMaxBlockPoints + random.below(3), random));
      }
      break;
    case 4:
    case 5:
    case 6:
      append_records(words, any_of(m.records, random.below(12), random));
      break;
    case 7:
    case 8:
      append_reduce(words, random.one_in(2));
      break;
    default:
      if (random.one_in(3)) words = {command_header(kIdentify, random.below(3))};
      if (random.one_in(8)) words = {(random.word() | 0x40000000u)};
      break;
  }
  return words;
}

// The answer's words, or none where nothing was asked.
std::vector<Word> take_answer(Device& device, Word header, std::size_t points) {
  std::vector<Word> answer;
  if (header_opcode(header) == kIdentify) {
    answer.resize(1 + kAnswerIdentity);
    device.receive(answer);
  } else if (header_opcode(header) == kReduce) {
    answer.resize(2);
    device.receive(answer);
    if (header_opcode(answer[0]) == kReduce) {
      std::vector<Word> rest(header_count(answer[0]) - 1);
      device.receive(rest);
      EXPECT_LE(rest.size(), 1 + points);
      answer.insert(answer.end(), rest.begin(), rest.end());
    }
  }
  return answer;
}

TEST(RtlDevice, AnswersAnyCommandsAsTheCppDevice) {
  const auto all = materials(5);
  std::uint64_t answers = 0, errors = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    CppDevice sim;
    RtlDevice rtl;
    for (int i = 0; i < 150; ++i) {
      const std::vector<Word> words = random_command(all, random);
      for (std::size_t sent = 0; sent < words.size();) {
        const std::size_t cut = std::min<std::size_t>(1 + random.below(50), words.size() - sent);
        sim.send(std::span(words).subspan(sent, cut));
        rtl.send(std::span(words).subspan(sent, cut));
        sent += cut;
      }
      if (words.empty()) continue;
      const auto expected = take_answer(sim, words[0], kMaxBlockPoints);
      ASSERT_EQ(take_answer(rtl, words[0], kMaxBlockPoints), expected) << "command " << i;
      answers += expected.empty() ? 0 : 1;
      errors += !expected.empty() && header_opcode(expected[0]) == kError ? 1 : 0;
    }
  }
  EXPECT_GT(answers, 200u);
  EXPECT_GT(errors, 20u);
  EXPECT_LT(errors, answers / 2 + answers / 4);
}

TEST(RtlDevice, CountsItsCycles) {
  RtlDevice device;
  const Material m = materials(6)[0];
  std::vector<Word> words;
  append_load_points(words, std::span(m.points).first(64));
  append_records(words, std::span(m.records).first(50));
  append_reduce(words, true);
  device.send(words);
  EXPECT_EQ(receive_reduce(device, 64, true).points_squared_bits.size(), 64u);
  const DeviceCounters counters = device.counters();
  EXPECT_EQ(counters.busy, 64u * 50u);
  EXPECT_EQ(counters.cycles, *counters.busy + *counters.stalled + *counters.idle);
  // One pair a cycle, and the pipeline once.
  EXPECT_LT(*counters.cycles, 64u * 50u + 200u);
}

// Takes records and pairs, and gives nothing.
class SilentElement : public ElementSimulation {
 public:
  std::uint32_t slot_bits() const override { return kDeviceSlotBits; }
  ElementOutputs outputs() const override {
    ElementOutputs o = {};
    o.record_ready = o.pair_ready = true;
    return o;
  }
  void offer_record(const RecordWords*) override {}
  void offer_pair(const Pair*) override {}
  void set_ready(bool, bool) override {}
  void settle() override {}
  void clock(bool) override {}
  bool assertion_failed() const override { return false; }
  void set_mutant(std::uint32_t) override {}
};

TEST(RtlDevice, SaysWhenNothingComes) {
  RtlDevice device(std::make_unique<SilentElement>());
  const Material m = materials(6)[0];
  std::vector<Word> words;
  append_load_points(words, std::span(m.points).first(5));
  append_records(words, std::span(m.records).first(5));
  append_reduce(words, false);
  EXPECT_THROW(device.send(words), Error);
  EXPECT_THROW(RtlDevice().receive(words), Error);
}

}  // namespace
}  // namespace emax
