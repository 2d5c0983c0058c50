#include "host/device/link_device.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "host/block_search/block_search.h"
#include "host/device/board_ports.h"
#include "host/device/device_evaluator.h"
#include "host/device/filtering_evaluator.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/protocol/cpp_board.h"
#include "testbench/board/simulated_board.h"
#include "testbench/link/faulty_channel.h"
#include "testbench/link/link_twin.h"
#include "tests/support/board_work.h"

namespace emax {
namespace {

using namespace std::chrono_literals;
using test::answers_of;
using test::Board;
using test::BoardKind;

Board make_twin(const TwinSettings& settings) {
  auto twin =
      std::make_unique<LinkedBoardTwin>([] { return std::make_unique<CppDevice>(); }, settings);
  const auto power_cycle = [board = twin.get()] { board->power_cycle(); };
  return {std::move(twin), power_cycle};
}

const BoardKind kTwin = {"twin", 24, 300, 60, [] { return make_twin({}); }};
// Its core takes words more slowly than they come, so its room is used up.
const BoardKind kSlowTwin = {"slow_twin", 12, 200, 60,
                             [] { return make_twin({.room = 512, .word_times = 9}); }};

// The Verilated board; its reset button takes its session, as a failing power supply would.
const BoardKind kUlx3s = {"ulx3s", 4, 100, 30, [] {
                            auto board = std::make_unique<SimulatedBoard>();
                            const auto power_cycle = [b = board.get()] { b->reset(); };
                            return Board{std::move(board), power_cycle};
                          }};

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

class Link : public testing::TestWithParam<BoardKind> {
 protected:
  void SetUp() override {
    seed_ = named_seed(testing::UnitTest::GetInstance()->current_test_info()->name(), 1);
  }

  // Must be called before connect().
  void faults(const ByteFaults& to_board, const ByteFaults& to_host) {
    to_board_ = to_board;
    to_host_ = to_host;
  }

  // The channel that the device uses; it lives as long as the device.
  FaultyChannel& make_channel() {
    auto channel = std::make_unique<FaultyChannel>(*board_.channel, seed_++, to_board_, to_host_);
    channel_ = channel.get();
    waiting_ = std::move(channel);
    return *channel_;
  }
  LinkDevice& connect() {
    if (!waiting_) make_channel();
    device_ = std::make_unique<LinkDevice>(std::move(waiting_));
    return *device_;
  }

  void expect_exact_answers() {
    EXPECT_EQ(answers_of(*device_, blocks_), test::undisturbed_answers(blocks_));
    report();
  }
  void report() const {
    const LinkCounters c = device_->link_counters();
    std::printf(
        "  %s: %s; %llu resends, %llu repeats, %llu damaged at the host, %llu misplaced, "
        "%llu polls, %llu recoveries, %llu losses, %.2f s\n",
        GetParam().name.c_str(), channel_->counts().text().c_str(),
        static_cast<unsigned long long>(c.resends), static_cast<unsigned long long>(c.repeats),
        static_cast<unsigned long long>(c.damaged), static_cast<unsigned long long>(c.misplaced),
        static_cast<unsigned long long>(c.polls), static_cast<unsigned long long>(c.recoveries),
        static_cast<unsigned long long>(c.losses),
        std::chrono::duration<double>(channel_->now()).count());
  }
  // In the middle of what the blocks take.
  std::uint64_t half_way() const {
    std::uint64_t words = 0;
    for (const test::Block& block : blocks_) words += block.size();
    return channel_->bytes_to_board() + 2 * words;
  }

  std::uint64_t seed_ = 0;
  ByteFaults to_board_, to_host_;
  const std::vector<test::Block> blocks_ = test::some_blocks(GetParam(), 41);
  Board board_ = GetParam().make();
  std::unique_ptr<FaultyChannel> waiting_;
  FaultyChannel* channel_ = nullptr;
  std::unique_ptr<LinkDevice> device_;
};

TEST_P(Link, NeedsNoResendWithoutFaults) {
  connect();
  expect_exact_answers();
  const LinkCounters counters = device_->link_counters();
  EXPECT_EQ(counters.resends, 0u);
  EXPECT_EQ(counters.damaged, 0u);
  EXPECT_EQ(counters.recoveries, 0u);
  EXPECT_EQ(device_->counters().resends, 0u);
}

TEST_P(Link, SurvivesFlippedBits) {
  for (const double rate : {1e-4, 1e-3}) {
    for (const int direction : {0, 1, 2}) {
      faults({.flip = direction == 1 ? 0 : rate}, {.flip = direction == 0 ? 0 : rate});
      connect();
      for (int round = 0; channel_->counts().flips < 2 && round < 30; ++round) {
        expect_exact_answers();
      }
      EXPECT_GE(channel_->counts().flips, 2u);
      const LinkCounters counters = device_->link_counters();
      EXPECT_GT(direction == 1 ? counters.damaged : counters.resends, 0u);
      device_.reset();
    }
  }
}

TEST_P(Link, SurvivesDroppedAndDoubledBytes) {
  for (const ByteFaults& f : {ByteFaults{.drop = 1e-3}, ByteFaults{.twice = 1e-3},
                              ByteFaults{.drop = 3e-4, .twice = 3e-4, .burst = 1e-4}}) {
    faults(f, f);
    connect();
    expect_exact_answers();
    EXPECT_GT(channel_->counts().drops + channel_->counts().doubles, 2u);
    EXPECT_GT(device_->link_counters().resends, 0u);
    EXPECT_GT(device_->link_counters().damaged, 0u);
    device_.reset();
  }
}

TEST_P(Link, SurvivesFramesOutOfOrder) {
  faults({.swap = 0.15}, {.swap = 0.2});
  connect();
  expect_exact_answers();
  EXPECT_GT(channel_->counts().swaps, 2u);
  EXPECT_GT(device_->link_counters().resends, 0u);
}

TEST_P(Link, SurvivesAStall) {
  connect();
  channel_->after_bytes(half_way(), [this] { channel_->stall(3s); });
  expect_exact_answers();
  EXPECT_EQ(channel_->counts().stalls, 1u);
  EXPECT_GT(channel_->now(), 3s);
  EXPECT_GT(device_->link_counters().resends, 0u);
}

TEST_P(Link, GivesUpALinkThatStaysStalled) {
  connect();
  channel_->after_bytes(half_way(), [this] { channel_->stall(1h); });
  const std::string error = error_of([this] { answers_of(*device_, blocks_); });
  EXPECT_NE(error.find("device " + channel_->name() + ": the board has not answered for 5 s"),
            std::string::npos)
      << error;
  EXPECT_EQ(channel_->counts().stalls, 1u);
  EXPECT_LT(channel_->now(), 15s);
}

TEST_P(Link, SaysThatNobodyAnswers) {
  make_channel().stall(1h);
  EXPECT_EQ(error_of([this] { connect(); }),
            "device " + board_.channel->name() +
                ": no emax board answered within 5 s; check the cable, the speed and that the "
                "bitstream is loaded, and run again");
  EXPECT_LT(board_.channel->now(), 6s);
}

TEST_P(Link, SurvivesABoardThatResetsInMidBlock) {
  connect();
  channel_->after_bytes(half_way(), board_.power_cycle);
  channel_->after_bytes(half_way() + 5000, board_.power_cycle);
  EXPECT_FALSE(device_->counters().began_again);
  expect_exact_answers();
  EXPECT_EQ(device_->link_counters().recoveries, 2u);
  EXPECT_TRUE(device_->counters().began_again);
}

TEST_P(Link, GivesUpABoardThatResetsAgainAndAgain) {
  connect();
  test::Block large;  // more than passes between two resets
  for (int i = 0; i < 6; ++i) {
    large.insert(large.end(), blocks_[0].begin(), blocks_[0].end() - 1);
  }
  large.push_back(blocks_[0].back());
  std::function<void()> again = [&] {
    board_.power_cycle();
    channel_->after_bytes(channel_->bytes_to_board() + 3 * large.size(), again);
  };
  again();
  const std::string error = error_of([&] { answers_of(*device_, {large}); });
  EXPECT_NE(error.find("the board forgot its work 9 times"), std::string::npos) << error;
}

TEST_P(Link, SurvivesABoardThatIsUnpluggedAndComesBack) {
  connect();
  channel_->after_bytes(half_way(), [this] {
    board_.power_cycle();
    channel_->unplug(10s);
  });
  expect_exact_answers();
  EXPECT_EQ(channel_->counts().unplugs, 1u);
  EXPECT_EQ(device_->link_counters().losses, 1u);
  EXPECT_EQ(device_->link_counters().recoveries, 1u);
}

TEST_P(Link, GivesUpABoardThatStaysUnplugged) {
  connect();
  channel_->after_bytes(half_way(), [this] { channel_->unplug(1h); });
  const std::string error = error_of([this] { answers_of(*device_, blocks_); });
  EXPECT_NE(error.find("the board has been gone for 30 s; plug it in and run again"),
            std::string::npos)
      << error;
  EXPECT_EQ(device_->link_counters().losses, 1u);
}

TEST_P(Link, SurvivesGarbageAtTheStart) {
  make_channel().add_garbage(3000);
  connect();
  expect_exact_answers();
  EXPECT_GT(device_->link_counters().damaged, 0u);
}

TEST_P(Link, TakesABoardOverFromAHostThatWasKilled) {
  for (int killed = 0; killed < 4; ++killed) {
    connect();
    channel_->after_bytes(half_way() + 1000 * static_cast<std::uint64_t>(killed),
                          [this] { channel_->unplug(1h); });
    EXPECT_NE(error_of([this] { answers_of(*device_, blocks_); }), "no error");
    device_.reset();
    waiting_.reset();
  }
  connect();
  expect_exact_answers();
  EXPECT_EQ(device_->link_counters().recoveries, 0u);
}

TEST_P(Link, LeavesTheBoardWithNothingUnderWay) {
  connect();
  device_->send(std::span(blocks_[0]).first(blocks_[0].size() / 2));
  device_->send(
      std::span(blocks_[0]).subspan(blocks_[0].size() / 2));  // its answer is never fetched
  device_.reset();
  // A status of the session that the host ended; nothing comes unasked any more.
  FrameReader reader;
  std::vector<std::uint8_t> bytes(4096);
  reader.add(std::span(bytes).first(board_.channel->read(bytes, 200ms)));
  EXPECT_EQ(reader.next(), std::nullopt);
}

TEST_P(Link, EveryFaultAtOnceChangesNoWord) {
  const ByteFaults all = {.flip = 1e-4, .drop = 1e-4, .twice = 1e-4, .burst = 2e-5, .swap = 0.02};
  faults(all, all);
  make_channel().add_garbage(500);
  connect();
  channel_->after_bytes(half_way() / 2, [this] { channel_->stall(700ms); });
  channel_->after_bytes(half_way(), board_.power_cycle);
  channel_->after_bytes(half_way() + 3000, [this] {
    board_.power_cycle();
    channel_->unplug(2s);
  });
  expect_exact_answers();
  EXPECT_GE(device_->link_counters().recoveries, 2u);
  EXPECT_GT(channel_->counts().flips, 0u);
}

TEST_P(Link, RefusesAnAnswerThatNobodyAskedFor) {
  connect();
  std::vector<Word> none(1);
  EXPECT_NE(error_of([&] { device_->receive(none); }).find("no command asked for"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Boards, Link, testing::Values(kTwin, kSlowTwin, kUlx3s),
                         [](const auto& board) { return board.param.name; });

TEST(LinkVersion, AnotherOneIsRefused) {
  EXPECT_EQ(error_of([] { LinkDevice(make_twin({.version = 1}).channel); }),
            "device twin: the board speaks version 1 of the link, this program version 2; load the "
            "bitstream that belongs to this program");
}

// A board with a store, behind the host's side of the link and the filter's.
struct StoringBoard {
  explicit StoringBoard(std::unique_ptr<ByteChannel> channel) {
    auto device = std::make_unique<LinkDevice>(std::move(channel));
    link = device.get();
    BoardPorts ports = ports_of(std::move(device));
    const std::size_t words = require_store(*ports.filter);
    evaluator = std::make_unique<FilteringEvaluator>(
        std::move(ports.filter), std::make_unique<DeviceEvaluator>(std::move(ports.exact)), words);
  }
  LinkDevice* link;
  std::unique_ptr<FilteringEvaluator> evaluator;
};

// Whether the search gives the model's answer although the board loses its power, and all that it
// stored, now and then.
bool survives_lost_stores() {
  auto channel = std::make_unique<LinkedBoardTwin>(
      [] { return std::make_unique<CppBoard>(1, 4, 14); }, TwinSettings{});
  LinkedBoardTwin& twin = *channel;
  StoringBoard board(std::move(channel));
  const test::Stimulus s = test::bumpy_sphere(20, 30, 6000, 91);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree mesh(s.mesh(), cloud.normalization());
  const EmaxResult expected = emax_model(cloud.points(), mesh.records());
  bool right = search_emax(cloud, mesh, *board.evaluator) == expected;
  int blocks = 0;
  SearchOptions options;
  options.interrupted = [&] {
    if (++blocks % 3 == 2) twin.power_cycle();
    return false;
  };
  right = search_emax(cloud, mesh, *board.evaluator, options) == expected && right;
  EXPECT_GT(board.link->link_counters().recoveries, 0u);
  return right;
}

TEST(LinkStore, IsFilledAgainAfterThePowerFailed) { EXPECT_TRUE(survives_lost_stores()); }

TEST(LinkStoreFault, OfAStoreThatIsNotFilledAgainIsCaught) {
  const DeliberateFault broken(Fault::kLogForgetsStored);
  EXPECT_FALSE(survives_lost_stores());
}

// The Verilated board: its cores, its store, its line.
TEST(LinkStore, KeepsCloudsAndMeshesOnTheSimulatedBoard) {
  StoringBoard board(std::make_unique<SimulatedBoard>());
  const test::Stimulus s = test::bumpy_sphere(8, 12, 400, 92),
                       other = test::bumpy_sphere(7, 9, 300, 93);
  std::vector<std::uint64_t> words;
  for (const test::Stimulus* stimulus : {&s, &s, &other, &s}) {
    const PreparedCloud cloud(stimulus->cloud);
    const TriangleTree mesh(stimulus->mesh(), cloud.normalization());
    const std::uint64_t before = board.evaluator->counters().words_in;
    EXPECT_EQ(search_emax(cloud, mesh, *board.evaluator),
              emax_model(cloud.points(), mesh.records()));
    words.push_back(board.evaluator->counters().words_in - before);
    std::printf("  %llu words\n", static_cast<unsigned long long>(words.back()));
  }
  EXPECT_LT(2 * words[1], words[0]);
}

// A core that takes so many byte times a word.
std::string load_slowly(std::uint32_t word_times, LinkCounters& counters) {
  return error_of([&] {
    LinkDevice device(make_twin({.word_times = word_times}).channel);
    std::vector<Word> words(31, 0x3f800000);
    words[0] = command_header(kLoadPoints, 10);
    words.push_back(command_header(kIdentify, 0));
    device.send(words);
    std::vector<Word> answers;
    test::receive_answer(device, answers);
    EXPECT_EQ(header_opcode(answers.at(0)), kIdentify);
    counters = device.link_counters();
  });
}

TEST(LinkLimit, ABusyBoardIsNotGone) {
  LinkCounters counters;
  EXPECT_EQ(load_slowly(600000, counters), "no error");  // 2 s a word, 64 s in all
  EXPECT_GT(counters.polls, 100u);
  EXPECT_EQ(counters.recoveries, 0u);
  EXPECT_EQ(counters.resends, 0u);
}

TEST(LinkLimit, ABoardThatOnlyTalksIsGivenUp) {
  LinkCounters counters;
  EXPECT_EQ(
      load_slowly(30000000, counters),
      "device twin: the board answers, but has done nothing for 60 s; reset the board and run "
      "again");
}

TEST(LinkLimit, FollowsTheSpeedOfTheLine) {
  EXPECT_EQ(LinkLimits::for_baud(3000000).repeat, 100ms);
  EXPECT_GT(LinkLimits::for_baud(115200).repeat, 700ms);
  EXPECT_GE(LinkLimits::for_baud(115200).silence, 14s);
}

// The tests above can fail: a board that takes damaged or misplaced frames gives other words, or
// the host notices.
TEST(LinkFault, ABoardThatTakesWhatItShouldNotIsCaught) {
  const auto blocks = test::some_blocks(kTwin, 42);
  const auto expected = test::undisturbed_answers(blocks);
  struct Case {
    TwinSettings settings;
    ByteFaults to_board;
  };
  for (const Case& c : {Case{{.ignores_crc = true}, {.flip = 1e-3}},
                        Case{{.ignores_sequence = true}, {.swap = 0.05}}}) {
    int caught = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      for (const bool faulty : {false, true}) {
        TwinSettings settings = c.settings;
        if (!faulty) settings.ignores_crc = settings.ignores_sequence = false;
        const Board board = make_twin(settings);
        std::vector<Word> answers;
        error_of([&] {
          LinkDevice device(std::make_unique<FaultyChannel>(*board.channel, seed, c.to_board),
                            {.standstill = 4s});
          answers = answers_of(device, blocks);
        });
        if (faulty) {
          caught += answers != expected;
        } else {
          EXPECT_EQ(answers, expected);
        }
      }
    }
    EXPECT_EQ(caught, 4);
  }
}

}  // namespace
}  // namespace emax
