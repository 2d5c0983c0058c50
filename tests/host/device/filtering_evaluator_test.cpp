#include "host/device/filtering_evaluator.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "evaluator_of.h"
#include "host/block_search/block_search.h"
#include "host/device/board_ports.h"
#include "host/device/device_evaluator.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/cpp_board.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

struct Pairs {
  std::vector<Vector3<float>> points;
  std::vector<TriangleRecord<float>> records;
};

Vector3<float> rounded(const Point& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

void add_triangle(Pairs& pairs, const std::array<Point, 3>& corners) {
  const auto index = static_cast<std::uint32_t>(pairs.records.size());
  pairs.records.push_back(make_record(make_frame(corners), index));
}

// Points that are equally far from a square but for less than the filter sees.
Pairs nearly_equal(std::uint64_t seed) {
  test::Random random(seed);
  Pairs pairs;
  const Point a(-0.25, -0.25, 0), b(0.25, -0.25, 0), c(0.25, 0.25, 0), d(-0.25, 0.25, 0);
  add_triangle(pairs, {a, b, c});
  add_triangle(pairs, {a, c, d});
  const double height = random.uniform(0.1, 0.2);
  for (int i = 0; i < 300; ++i) {
    const double x = random.uniform(-0.2, 0.2), y = random.uniform(-0.2, 0.2);
    pairs.points.push_back(rounded(Point(x, y, random.uniform(height, height + 0x1p-22))));
  }
  return pairs;
}

// A small triangle in one corner of a cube, and points in the cube: differences leave the range.
Pairs far_from_a_triangle(std::uint64_t seed) {
  test::Random random(seed);
  Pairs pairs;
  add_triangle(pairs,
               {Point(-0.9, -0.9, -0.9), Point(-0.85, -0.9, -0.9), Point(-0.9, -0.85, -0.9)});
  for (int i = 0; i < 200; ++i) pairs.points.push_back(rounded(random.point(-0.95, 0.95)));
  return pairs;
}

// No triangle fits the filter.
Pairs beyond_the_filter(std::uint64_t seed) {
  test::Random random(seed);
  Pairs pairs;
  add_triangle(pairs, {Point(-9, -9, 90), Point(9, -9, 90), Point(0, 9, 90)});
  for (int i = 0; i < 50; ++i) pairs.points.push_back(rounded(random.point(-0.5, 0.5)));
  return pairs;
}

// All pairs in blocks of so many points.
EmaxResult answer_of(Evaluator& evaluator, const Pairs& pairs, std::size_t block_points) {
  evaluator.begin(pairs.points, pairs.records);
  std::vector<std::uint32_t> candidates(pairs.records.size());
  for (std::uint32_t i = 0; i < candidates.size(); ++i) candidates[i] = i;
  std::optional<EmaxResult> worst;
  for (std::uint32_t next = 0; next < pairs.points.size();) {
    Block block{{}, candidates};
    while (next < pairs.points.size() && block.points.size() < block_points) {
      block.points.push_back(next++);
    }
    evaluator.submit(block, false);
    const EmaxResult answer = evaluator.collect().worst;
    const bool is_worse =
        !worst || answer.squared_bits > worst->squared_bits ||
        (answer.squared_bits == worst->squared_bits && answer.worst_point < worst->worst_point);
    if (is_worse) worst = answer;
  }
  return *worst;
}

using MakePairs = Pairs (*)(std::uint64_t);

// Behind a store of so many bits, 0 for none.
std::unique_ptr<Evaluator> filtered_by(unsigned store_bits) {
  if (store_bits == 0) return test::evaluator_of("sim:filter");
  BoardPorts ports = ports_of(std::make_unique<CppBoard>(1, 4, store_bits));
  const std::size_t words = require_store(*ports.filter);
  return std::make_unique<FilteringEvaluator>(
      std::move(ports.filter), std::make_unique<DeviceEvaluator>(std::move(ports.exact)), words);
}

bool is_right(MakePairs make, unsigned store_bits = 0) {
  const auto filtered = filtered_by(store_bits);
  for (std::uint64_t seed = 70; seed < 90; ++seed) {
    const Pairs pairs = make(seed);
    const EmaxResult expected = emax_model(pairs.points, pairs.records);
    for (const std::size_t block_points : {1, 7, 64, 1024}) {
      if (answer_of(*filtered, pairs, block_points) != expected) return false;
    }
  }
  return true;
}

TEST(FilteringEvaluator, GivesTheModelsAnswer) {
  EXPECT_TRUE(is_right(nearly_equal));
  EXPECT_TRUE(is_right(far_from_a_triangle));
  EXPECT_TRUE(is_right(beyond_the_filter));
}

// One cloud after the other behind one store, which holds all of them or a part.
TEST(FilteringEvaluator, GivesTheModelsAnswerBehindAStore) {
  for (const unsigned bits : {8u, 12u, 13u, 17u}) {
    SCOPED_TRACE(bits);
    EXPECT_TRUE(is_right(nearly_equal, bits));
    EXPECT_TRUE(is_right(far_from_a_triangle, bits));
    EXPECT_TRUE(is_right(beyond_the_filter, bits));
  }
}

TEST(FilteringEvaluatorFault, OfAnOldCloudIsCaught) {
  const DeliberateFault broken(Fault::kStoreTrustsOldItems);
  EXPECT_FALSE(is_right(nearly_equal, 17));
}

TEST(FilteringEvaluatorFault, OfTrustInTheGreatestResultIsCaught) {
  const DeliberateFault broken(Fault::kFilterTrustsGreatest);
  EXPECT_FALSE(is_right(nearly_equal, 17));
}

TEST(FilteringEvaluatorFault, OfANearestThatIsDroppedIsCaught) {
  const DeliberateFault broken(Fault::kFilterDropsNearest);
  EXPECT_FALSE(is_right(far_from_a_triangle));
}

TEST(FilteringEvaluatorFault, OfAMissingMarginIsCaught) {
  const DeliberateFault broken(Fault::kFilterWithoutMargin);
  EXPECT_FALSE(is_right(nearly_equal));
}

TEST(FilteringEvaluatorFault, OfTrustInSaturatedNumbersIsCaught) {
  const DeliberateFault broken(Fault::kFilterTrustsSaturated);
  EXPECT_FALSE(is_right(far_from_a_triangle));
}

TEST(FilteringEvaluatorFault, OfAGreatestThatIsNotKnownIsCaught) {
  const DeliberateFault broken(Fault::kFilterKeepsOldGreatest);
  EXPECT_FALSE(is_right(nearly_equal));
}

struct Filtered {
  explicit Filtered(std::size_t points, std::uint64_t seed)
      : stimulus(test::bumpy_sphere(30, 40, points, seed)),
        cloud(stimulus.cloud),
        mesh(stimulus.mesh(), cloud.normalization()) {}
  test::Stimulus stimulus;
  PreparedCloud cloud;
  TriangleTree mesh;
};

TEST(FilteringEvaluator, LeavesFewPointsToTheKernel) {
  const Filtered work(20000, 81);
  const auto filtered = test::evaluator_of("sim:filter");
  const auto exact = test::evaluator_of("sim");
  EXPECT_EQ(search_emax(work.cloud, work.mesh, *filtered),
            search_emax(work.cloud, work.mesh, *exact));
  const DeviceCounters counters = filtered->counters();
  std::printf("%llu of %llu points left, %llu pairs of %llu\n",
              static_cast<unsigned long long>(*counters.points_left),
              static_cast<unsigned long long>(*counters.filtered_points),
              static_cast<unsigned long long>(counters.pairs),
              static_cast<unsigned long long>(exact->counters().pairs));
  EXPECT_EQ(counters.blocks, exact->counters().blocks);
  EXPECT_LT(*counters.points_left * 4, *counters.filtered_points);
  EXPECT_LT(counters.pairs * 4, exact->counters().pairs);
}

// The cloud stays between meshes; the mesh stays between measurements.
TEST(FilteringEvaluator, SendsWhatStaysOnce) {
  const Filtered work(20000, 81);
  const auto board = filtered_by(17);
  std::vector<std::uint64_t> words;
  const test::Stimulus other_mesh = test::bumpy_sphere(25, 30, 100, 89);
  const TriangleTree other(other_mesh.mesh(), work.cloud.normalization());
  for (const TriangleTree* mesh : {&work.mesh, &work.mesh, &other}) {
    const std::uint64_t before = board->counters().words_in;
    EXPECT_EQ(search_emax(work.cloud, *mesh, *board),
              search_emax(work.cloud, *mesh, *test::evaluator_of("cpu")));
    words.push_back(board->counters().words_in - before);
  }
  std::printf("%llu words, then %llu, with another mesh %llu\n",
              static_cast<unsigned long long>(words[0]), static_cast<unsigned long long>(words[1]),
              static_cast<unsigned long long>(words[2]));
  EXPECT_LT(words[1] * 4, words[0]);
  EXPECT_LT(words[2], words[0]);
}

// The model's cycles are those counted but for a part of `tolerance`.
void expect_equal_counts(const char* in_cpp, const char* verilated, double tolerance) {
  const Filtered work(2000, 82);
  const auto sim = test::evaluator_of(in_cpp), rtl = test::evaluator_of(verilated);
  // A search leaves too few pairs for a part of their cycles to say much.
  EXPECT_EQ(brute_force_emax(work.cloud, work.mesh, *sim),
            brute_force_emax(work.cloud, work.mesh, *rtl));
  const DeviceCounters of_sim = sim->counters(), of_rtl = rtl->counters();
  EXPECT_EQ(of_sim.pairs, of_rtl.pairs);
  EXPECT_EQ(of_sim.words_in, of_rtl.words_in);
  EXPECT_EQ(of_sim.words_out, of_rtl.words_out);
  EXPECT_EQ(of_sim.filtered_pairs, of_rtl.filtered_pairs);
  EXPECT_EQ(of_sim.points_left, of_rtl.points_left);
  EXPECT_EQ(of_sim.busy, of_rtl.busy);
  // The cores count what they wait for the host as idle.
  const auto counted = static_cast<double>(*of_rtl.busy + *of_rtl.stalled);
  EXPECT_NEAR(static_cast<double>(*of_sim.cycles) / counted, 1, tolerance);
}

TEST(FilteringEvaluator, CountsTheSameOnEveryDevice) {
  expect_equal_counts("sim:filter", "rtl:filter", 0.002);
}

TEST(FilteringEvaluator, CountsTheSameOnEveryBoard) {
  expect_equal_counts("sim:board=ulx3s", "rtl:board", 0.02);
}

TEST(FilteringEvaluator, ListsThePointsOfABlockByTheKernel) {
  const Filtered work(2500, 83);
  const auto filtered = test::evaluator_of("sim:filter");
  EXPECT_EQ(search_nearest(work.cloud, work.mesh, *filtered),
            nearest_squared_bits(work.cloud.points(), work.mesh.records()));
  EXPECT_EQ(filtered->counters().filtered_pairs, 0u);
}

TEST(FilteringEvaluator, StartsAfreshAfterAnInterruptedSearch) {
  const Filtered work(20000, 84), other(3000, 85);
  const auto filtered = test::evaluator_of("sim:filter");
  int asked = 0;
  SearchOptions options;
  options.interrupted = [&asked] { return ++asked > 2; };
  EXPECT_THROW(search_emax(work.cloud, work.mesh, *filtered, options), Interrupted);
  // Its points are nearer than those of the first cloud or not: nothing of that is remembered.
  for (const Filtered* next : {&other, &work}) {
    EXPECT_EQ(search_emax(next->cloud, next->mesh, *filtered),
              search_emax(next->cloud, next->mesh, *test::evaluator_of("cpu")));
  }
}

// Takes words until it is gone.
class Leaving : public Device {
 public:
  std::string name() const override { return "leaving"; }
  void send(std::span<const Word> words) override {
    if (gone) throw Error("unplugged");
    device_.send(words);
  }
  void receive(std::span<Word> words) override { device_.receive(words); }
  DeviceCounters counters() const override { return device_.counters(); }

  bool gone = false;

 private:
  CppFilter device_;
};

TEST(FilteringEvaluator, SaysWhenTheFilterIsGoneOrIsNone) {
  const auto exact = [] { return test::evaluator_of("sim"); };
  EXPECT_THROW(FilteringEvaluator(std::make_unique<CppDevice>(), exact()), Error);
  auto made = std::make_unique<Leaving>();
  Leaving& device = *made;
  FilteringEvaluator evaluator(std::move(made), exact());
  const Filtered work(3000, 86);
  search_emax(work.cloud, work.mesh, evaluator);
  device.gone = true;
  EXPECT_THROW(search_emax(work.cloud, work.mesh, evaluator), DeviceFailure);
  EXPECT_GT(evaluator.counters().filtered_pairs.value(), 0u);
}

}  // namespace
}  // namespace emax
