// The timing diagrams of docs/datasheet.md are what the simulated hardware does.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "testbench/core/core_driver.h"
#include "testbench/core/rtl_device.h"
#include "testbench/element/element_run.h"
#include "testbench/element/verilated_variants.h"
#include "tests/support/temporary_folder.h"
#include "wave_diagram.h"

namespace emax {
namespace {

// Of hls/rtl/mutation.sv.
constexpr std::uint32_t kLastLost = 115, kReduceLeavesBlockOpen = 122;

const TriangleRecord<float> kRecord =
    make_record(make_frame({Point(0, 0, 0), Point(0, 0, 2), Point(0, 1, 1)}), 0);
const std::array<Vector3<float>, 2> kPoints = {{{2, 0.25f, 1}, {0, 0.25f, -3}}};

WaveValue wire(const std::string& signal, bool value) { return {signal, value ? "1" : "0", true}; }
WaveValue words(const std::string& signal, bool valid, const std::string& name) {
  return {signal, valid ? name : "", false};
}

// A block of two points that meets one record. The record waits for the element, the first pair for
// the record, the first squared distance for two cycles until it is taken.
std::vector<WaveCycle> element_waves(ElementSimulation& element) {
  constexpr std::size_t kReset = 2, kWaits = 2, kAfter = 4;
  const RecordWords record = to_words(kRecord);
  std::array<std::uint32_t, 2> squared;
  std::array<Pair, 2> pairs;
  for (std::uint32_t i = 0; i < 2; ++i) {
    squared[i] = pair_squared_bits(kPoints[i], kRecord);
    pairs[i] = {{float_bits(kPoints[i].x), float_bits(kPoints[i].y), float_bits(kPoints[i].z)},
                i,
                true,
                true,
                i == 1,
                i == 1};
  }
  std::vector<WaveCycle> cycles;
  std::size_t sent = 0, received = 0, waited = 0, after = 0;
  bool record_sent = false;
  while (after < kAfter) {
    if (cycles.size() > 1000) throw std::runtime_error("the element gives no answer");
    const bool reset = cycles.size() < kReset;
    const ElementOutputs out = element.outputs();
    const bool record_valid = !reset && !record_sent;
    const bool pair_valid = !reset && sent < pairs.size();
    const bool ready = out.nearest_valid && waited >= kWaits;
    element.offer_record(record_valid ? &record : nullptr);
    element.offer_pair(pair_valid ? &pairs[sent] : nullptr);
    element.set_ready(ready, true);
    const std::string point = "p" + std::to_string(sent);
    const auto name = [&](Word bits) {
      return bits == squared[0] ? "d0" : bits == squared[1] ? "d1" : "?";
    };
    cycles.push_back(
        {wire("aresetn", !reset), wire("s_axis_record_tvalid", record_valid),
         wire("s_axis_record_tready", out.record_ready),
         words("s_axis_record_tdata", record_valid, "record"),
         wire("s_axis_point_tvalid", pair_valid), wire("s_axis_point_tready", out.pair_ready),
         words("s_axis_point_tdata", pair_valid, point),
         wire("s_axis_point_tlast", pair_valid && pairs[sent].last),
         wire("m_axis_nearest_tvalid", out.nearest_valid), wire("m_axis_nearest_tready", ready),
         words("m_axis_nearest_tdata", out.nearest_valid, name(out.nearest)),
         wire("m_axis_nearest_tlast", out.nearest_valid && out.nearest_last),
         wire("m_axis_worst_tvalid", out.worst_valid),
         words("m_axis_worst_tdata", out.worst_valid,
               std::to_string(out.worst_index) + ", " + name(out.worst_squared))});
    record_sent = record_sent || (record_valid && out.record_ready);
    if (pair_valid && out.pair_ready) ++sent;
    if (ready) ++received;
    waited = out.nearest_valid ? waited + 1 : 0;
    if (received == pairs.size()) ++after;
    element.clock(reset);
  }
  return cycles;
}

std::size_t first_with(const std::vector<WaveCycle>& cycles, const std::string& signal,
                       const std::string& value) {
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    for (const WaveValue& shown : cycles[cycle]) {
      if (shown.signal == signal && shown.value == value) return cycle;
    }
  }
  throw std::runtime_error(signal + " is never " + value);
}

std::string element_json(ElementSimulation& element) {
  const auto cycles = element_waves(element);
  // Cycle 0 is that in which the first pair is accepted.
  const std::size_t accepted = first_with(cycles, "s_axis_point_tready", "1");
  const std::size_t answered = first_with(cycles, "m_axis_nearest_tvalid", "1");
  return wave_json(cycles, {{0, accepted + 3}, {answered - 1, cycles.size() - 1}}, accepted);
}

// A block of one point and one record, sent without a pause.
std::vector<WaveCycle> core_waves(CoreSimulation& core) {
  constexpr std::size_t kReset = 2, kAfter = 2;
  std::vector<Word> commands;
  append_load_points(commands, std::span(kPoints).first(1));
  append_records(commands, std::span(&kRecord, 1));
  append_reduce(commands, false);
  std::vector<std::string> names = {"load", "x", "y", "z", "rec"};
  for (std::uint32_t i = 0; i < kRecordWords; ++i) names.push_back("w" + std::to_string(i));
  names.push_back("red");
  const std::vector<Word> answers = answers_of_kernel(commands);
  const std::array<std::string, 3> parts = {"red", "d²", "i"};

  std::vector<WaveCycle> cycles;
  std::size_t sent = 0, received = 0, after = 0;
  while (after < kAfter) {
    if (cycles.size() > 1000) throw std::runtime_error("the core gives no answer");
    const bool reset = cycles.size() < kReset;
    const CoreOutputs out = core.outputs();
    const bool valid = !reset && sent < commands.size();
    core.offer_command(valid ? &commands[sent] : nullptr);
    core.set_answer_ready(true);
    const bool right = received < answers.size() && out.answer == answers[received];
    cycles.push_back({wire("aresetn", !reset), wire("s_axis_command_tvalid", valid),
                      wire("s_axis_command_tready", out.command_ready),
                      words("s_axis_command_tdata", valid, valid ? names[sent] : ""),
                      wire("m_axis_answer_tvalid", out.answer_valid),
                      words("m_axis_answer_tdata", out.answer_valid, right ? parts[received] : "?"),
                      wire("under_way", out.under_way)});
    if (valid && out.command_ready) ++sent;
    if (out.answer_valid) ++received;
    if (received == answers.size() && !out.under_way) ++after;
    core.clock(reset);
  }
  return cycles;
}

std::string core_json(CoreSimulation& core) {
  const auto cycles = core_waves(core);
  const std::size_t accepted = first_with(cycles, "s_axis_command_tready", "1");
  const std::size_t reduced = first_with(cycles, "s_axis_command_tdata", "red");
  const std::size_t answered = first_with(cycles, "m_axis_answer_tvalid", "1");
  const std::size_t found = first_with(cycles, "m_axis_answer_tdata", "d²");
  return wave_json(cycles,
                   {{0, accepted + 6},
                    {reduced - 1, reduced + 1},
                    {answered - 1, answered + 1},
                    {found - 1, cycles.size() - 1}},
                   accepted);
}

void expect_file(const std::string& name, const std::string& text) {
  const std::string path = std::string(EMAX_PICTURES) + "/" + name;
  if (test::bytes_of(path) == text) return;
  std::ofstream(name, std::ios::binary) << text;
  FAIL() << "the hardware no longer does what " << path << " says: what it does is in "
         << std::filesystem::absolute(name) << "; where that is meant, put it there and run "
         << "./dev docs --pictures";
}

TEST(Timing, ElementDoesWhatTheDatasheetDraws) {
  expect_file("timing_element.json", element_json(*make_plain_element(kDeviceSlotBits)));
}

TEST(Timing, CoreDoesWhatTheDatasheetDraws) {
  expect_file("timing_core.json", core_json(*make_core(1)));
}

TEST(Timing, ChangesWithTheElement) {
  const auto element = make_mutated_element(kPairsSlotBits);
  const std::string drawn = element_json(*element);
  EXPECT_EQ(drawn, element_json(*make_plain_element(kDeviceSlotBits)));
  element->set_mutant(kLastLost);
  EXPECT_NE(element_json(*element), drawn);
}

TEST(Timing, ChangesWithTheCore) {
  const auto core = make_mutated_core();
  EXPECT_EQ(core_json(*core), core_json(*make_core(2)));
  core->set_mutant(kReduceLeavesBlockOpen);
  EXPECT_THROW(core_json(*core), std::runtime_error);  // it stays under way
}

TEST(WaveDiagram, RefusesAChangeInAGap) {
  const std::vector<WaveCycle> cycles = {{wire("a", false)}, {wire("a", true)}, {wire("a", false)}};
  EXPECT_NO_THROW(wave_json(cycles, {{0, 2}}, 0));
  EXPECT_THROW(wave_json(cycles, {{0, 0}, {2, 2}}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace emax
