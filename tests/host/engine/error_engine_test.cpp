#include "host/engine/error_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <numeric>

#include "host/block_search/block_search.h"
#include "host/block_search/simd_evaluator.h"
#include "sw_model/base/error.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Bits = std::vector<std::uint32_t>;

constexpr std::pair<Strategy, const char*> kStrategies[] = {{Strategy::kAutomatic, "automatic"},
                                                            {Strategy::kPackets, "packets"},
                                                            {Strategy::kBestFirst, "best-first"}};

std::vector<test::Stimulus> stimuli() {
  std::vector<test::Stimulus> all;
  for (std::uint64_t seed = 70; seed < 73; ++seed) {
    for (test::Stimulus& s : test::all_stimuli(seed)) {
      s.name += ", seed " + std::to_string(seed);
      all.push_back(std::move(s));
    }
  }
  return all;
}

// What the model says, the triangles in file order.
struct BruteForce {
  explicit BruteForce(const test::Stimulus& s)
      : cloud(s.cloud),
        nearest(
            nearest_squared_bits(cloud.points(), make_records(s.mesh(), cloud.normalization()))),
        worst(worst_of(nearest)) {}
  PreparedCloud cloud;
  Bits nearest;
  EmaxResult worst;
};

struct SettledPackets {
  explicit SettledPackets(const PacketView& packets) : settled(packets.packets.size()) {}
  Settled settled_on(std::uint32_t now, std::span<const std::uint32_t> carried = {}) {
    return {settled, now, now - 1, carried};
  }
  std::vector<SettledPacket> settled;
};

// How many of the engine's answers differ from brute force, of how many.
struct Tally {
  int wrong = 0, asked = 0;
  void count(bool right) {
    ++asked;
    wrong += !right;
  }
};

void ask_everything(ErrorEngine& engine, const PreparedMesh& mesh, const BruteForce& expected,
                    Tally& tally) {
  tally.count(engine.e_max(mesh) == expected.worst);
  tally.count(engine.e_max(mesh) == expected.worst);  // warm
  tally.count(engine.squared_distances(mesh) == expected.nearest);
  const std::uint32_t worst = expected.worst.squared_bits;
  Bits ranked = expected.nearest;
  std::ranges::sort(ranked);
  for (const std::uint32_t limit : {0u, ranked[ranked.size() / 2], worst - (worst > 0), worst,
                                    worst + 1, float_bits(0x1p80f)}) {
    const auto violation = engine.violation(mesh, limit);
    tally.count(
        violation.has_value() == (worst > limit) &&
        (!violation || (violation->squared_bits > limit &&
                        violation->squared_bits == expected.nearest[violation->worst_point])));
  }
  for (const std::size_t percent : {0u, 7u, 50u, 99u, 100u}) {
    const double share = percent == 0 ? 1e-9 : static_cast<double>(percent) / 100;
    const Quantile quantile = engine.quantile(mesh, share);
    const std::size_t rank = std::max<std::size_t>((percent * ranked.size() + 99) / 100, 1);
    Bits beyond;
    for (std::uint32_t i = 0; i < expected.nearest.size(); ++i) {
      if (expected.nearest[i] > quantile.squared_bits) beyond.push_back(i);
    }
    tally.count(quantile.squared_bits == ranked[rank - 1] && quantile.beyond == beyond);
  }
}

TEST(ErrorEngine, EveryStrategyAndTargetGivesBruteForcesBits) {
  const auto all = stimuli();
  std::map<std::string, Tally> matrix;
  for (const test::Stimulus& s : all) {
    const BruteForce expected(s);
    for (const EngineTarget& target : engine_targets()) {
      const PreparedMesh mesh(s.mesh(), expected.cloud.normalization(), target);
      for (const auto& [strategy, strategy_name] : kStrategies) {
        for (const std::size_t threads : {1, 3}) {
          EngineOptions options;
          options.threads = threads;
          options.strategy = strategy;
          options.target = &target;
          ErrorEngine engine(expected.cloud, options);
          Tally tally;
          ask_everything(engine, mesh, expected, tally);
          EXPECT_EQ(tally.wrong, 0) << s.name << ", " << target.name << ", " << strategy_name
                                    << ", " << threads << " threads";
          Tally& sum = matrix[std::string(target.name) + ", " + strategy_name + ", " +
                              std::to_string(threads) + " threads"];
          sum.wrong += tally.wrong;
          sum.asked += tally.asked;
        }
      }
    }
  }
  EXPECT_FALSE(flush_mode_is_on());
  std::cout << all.size() << " clouds and meshes; questions, and answers unlike brute force's:\n";
  for (const auto& [row, tally] : matrix) {
    std::cout << "  " << row << ": " << tally.asked << ", " << tally.wrong << '\n';
    EXPECT_GT(tally.asked, 0);
  }
}

TEST(ErrorEngine, EqualsTheSearchInBlocks) {
  const test::Stimulus s = test::bumpy_sphere(60, 80, 20000, 71);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree tree(s.mesh(), cloud.normalization());
  const PreparedMesh mesh(s.mesh(), cloud.normalization());
  SimdEvaluator cpu;
  ErrorEngine engine(cloud);
  EXPECT_EQ(engine.e_max(mesh), search_emax(cloud, tree, cpu));
  EXPECT_EQ(engine.squared_distances(mesh), search_nearest(cloud, tree, cpu));
}

// One engine, a mesh after another: what is remembered changes no answer.
TEST(ErrorEngine, RemembersWithoutError) {
  const test::Stimulus fine = test::bumpy_sphere(40, 60, 20000, 72);
  const PreparedCloud cloud(fine.cloud);
  EngineOptions two_threads;
  two_threads.threads = 2;
  ErrorEngine engine(cloud), other(cloud, two_threads);
  for (const std::uint32_t rings : {40u, 20u, 39u, 5u, 40u}) {
    const test::Stimulus s = test::bumpy_sphere(rings, rings + 20, 10, 72);
    const PreparedMesh mesh(s.mesh(), cloud.normalization());
    const EmaxResult cold = ErrorEngine(cloud).e_max(mesh);
    EXPECT_EQ(engine.e_max(mesh), cold) << rings;
    EXPECT_EQ(other.e_max(mesh), cold) << rings;
    const std::uint32_t half = float_bits(bits_float(cold.squared_bits) / 4);
    const auto violation = engine.violation(mesh, half);
    ASSERT_TRUE(violation);
    EXPECT_EQ(*violation, other.violation(mesh, half)) << rings;
  }
}

// A mesh and what becomes of it in the hands of a decimator: vertices moved, triangles dropped, the
// order of those that stay another.
test::Stimulus edited(test::Stimulus s, test::Random& random) {
  for (int i = 0; i < 6; ++i) {
    Point& moved = s.vertices[random.below(s.vertices.size())];
    moved += random.point(-0.3, 0.3);
  }
  for (int i = 0; i < 20; ++i) {
    s.triangles.erase(s.triangles.begin() +
                      static_cast<std::ptrdiff_t>(random.below(s.triangles.size())));
  }
  for (std::size_t i = s.triangles.size(); i > 1; --i) {
    std::swap(s.triangles[i - 1], s.triangles[random.below(i)]);
  }
  return s;
}

TEST(ErrorEngine, KeepsWhatStillHolds) {
  for (const EngineTarget& target : engine_targets()) {
    test::Random random(78);
    test::Stimulus s = test::bumpy_sphere(40, 60, 20000, 78);
    const PreparedCloud cloud(s.cloud);
    EngineOptions options;
    options.target = &target;
    ErrorEngine warm(cloud, options);
    options.threads = 3;
    ErrorEngine in_threads(cloud, options);
    for (int step = 0; step < 12; ++step, s = edited(s, random)) {
      SCOPED_TRACE(std::string(target.name) + ", step " + std::to_string(step));
      const PreparedMesh mesh(s.mesh(), cloud.normalization());
      const auto nearest = ErrorEngine(cloud).squared_distances(mesh);
      const EmaxResult worst = worst_of(nearest);
      // Questions that end early leave packets with what was known before.
      const std::uint32_t limit = nearest[random.below(nearest.size())];
      if (step % 3 == 1) {
        const auto violation = warm.violation(mesh, limit);
        ASSERT_EQ(violation.has_value(), worst.squared_bits > limit);
        if (violation) {
          EXPECT_EQ(violation->squared_bits, nearest[violation->worst_point]);
        }
      }
      if (step % 4 == 2) continue;
      EXPECT_EQ(warm.e_max(mesh), worst);
      EXPECT_EQ(in_threads.e_max(mesh), worst);
      EXPECT_EQ(warm.violation(mesh, worst.squared_bits), std::nullopt);
    }
  }
}

// A mesh that passes for the one before without having its triangles: what the test above would
// see.
TEST(ErrorEngine, FalselyCarriedTrianglesAreCaught) {
  test::Stimulus s = test::bumpy_sphere(40, 60, 20000, 79);
  const PreparedCloud cloud(s.cloud);
  const PacketView packets = cloud.packets();
  SettledPackets settled(packets);
  std::vector<std::uint32_t> raised, carried(s.triangles.size());
  std::iota(carried.begin(), carried.end(), 0u);
  carried.push_back(kNoLeaf);
  const PreparedMesh near(s.mesh(), cloud.normalization());
  const std::uint32_t limit = ErrorEngine(cloud).e_max(near).squared_bits;
  const auto search = [&](const PreparedMesh& mesh, std::uint32_t number) {
    RunningMaximum worst;
    worst.raise({limit, 0});
    const ScopedFlushMode flush;
    engine_targets().front().search_supergroups(
        {packets, mesh.tree(), Strategy::kPackets, worst, std::numeric_limits<std::uint32_t>::max(),
         raised, settled.settled_on(number, carried)},
        0, packets.supergroups.size());
    return worst.get();
  };
  EXPECT_EQ(search(near, 2).squared_bits, limit);
  for (Point& vertex : s.vertices) vertex += Point(1000, 0, 0);
  const PreparedMesh far(s.mesh(), cloud.normalization());
  EXPECT_EQ(search(far, 3).squared_bits, limit);
  EXPECT_GT(search(far, 5).squared_bits, limit);  // those of mesh 3 are not of mesh 4
}

// Boxes that are too small hide triangles: what the tests above would see.
TEST(ErrorEngine, TooSmallBoxesAreCaught) {
  int wrong = 0;
  for (const test::Stimulus& s : stimuli()) {
    const BruteForce expected(s);
    const PreparedMesh mesh(s.mesh(), expected.cloud.normalization());
    const TreeView right = mesh.tree();
    std::vector<std::vector<BoxBlock>> levels;
    std::vector<std::span<const BoxBlock>> spans;
    for (const auto& level : right.levels) {
      levels.emplace_back(level.begin(), level.end());
      for (BoxBlock& block : levels.back()) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (std::size_t c = 0; c < kTreeWidth; ++c) {
            const float middle = (block.lo[axis][c] + block.hi[axis][c]) / 2;
            if (!std::isfinite(middle)) continue;
            block.lo[axis][c] = block.hi[axis][c] = middle;
          }
        }
      }
    }
    for (const auto& level : levels) spans.emplace_back(level);
    Bits nearest(expected.nearest.size());
    RunningMaximum unused;
    std::vector<std::uint32_t> raised;
    const PacketView packets = expected.cloud.packets();
    const ScopedFlushMode flush;
    engine_targets().front().nearest(
        {packets, {right.records, right.reach, spans}, Strategy::kBestFirst, unused, 0, raised, {}},
        0, packets.supergroups.size(), nearest);
    wrong += nearest != expected.nearest;
  }
  EXPECT_GT(wrong, 0);
}

// Prisms that are too wide, by a reach below the truth, and balls that are too small accept points
// beyond the limit.
TEST(ErrorEngine, TooWidePrismsAndTooSmallBallsAreCaught) {
  enum { kNoFault, kPrisms, kBalls };
  int wrong[] = {0, 0, 0};
  for (const test::Stimulus& s : stimuli()) {
    const BruteForce expected(s);
    const PreparedMesh mesh(s.mesh(), expected.cloud.normalization());
    for (const int fault : {kNoFault, kPrisms, kBalls}) {
      PacketView packets = expected.cloud.packets();
      TreeView tree = mesh.tree();
      std::vector<PacketBalls> balls(packets.balls.begin(), packets.balls.end());
      packets.balls = balls;
      for (PacketBalls& b : balls) {
        if (fault == kPrisms) b.radius.fill(std::numeric_limits<float>::infinity());
        if (fault == kBalls) b.radius.fill(0);
      }
      if (fault == kPrisms) tree.reach = -1e4f;
      RunningMaximum worst;
      std::vector<std::uint32_t> raised;
      SettledPackets none(packets);
      const std::uint32_t seed = 0, never_enough = std::numeric_limits<std::uint32_t>::max();
      const SearchJob job = {packets,      tree,   Strategy::kPackets, worst,
                             never_enough, raised, none.settled_on(2)};
      const ScopedFlushMode flush;
      engine_targets().front().search_packets(job, {&seed, 1});
      engine_targets().front().search_supergroups(job, 0, packets.supergroups.size());
      wrong[fault] += !(worst.get() == expected.worst);
    }
  }
  EXPECT_EQ(wrong[kNoFault], 0);
  EXPECT_GT(wrong[kPrisms], 0);
  EXPECT_GT(wrong[kBalls], 0);
}

test::Stimulus one_triangle(std::vector<Point> cloud) {
  return {"one triangle",
          std::move(cloud),
          {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)},
          {{0, 1, 2}}};
}

void expect_brute_force(const test::Stimulus& s) {
  SCOPED_TRACE(s.name);
  const BruteForce expected(s);
  const PreparedMesh mesh(s.mesh(), expected.cloud.normalization());
  ErrorEngine engine(expected.cloud);
  Tally tally;
  ask_everything(engine, mesh, expected, tally);
  EXPECT_EQ(tally.wrong, 0);
}

TEST(ErrorEngine, TakesWhatIsSmallFarOrCoincident) {
  expect_brute_force(one_triangle({Point(0.2, 0.2, 0.5)}));
  test::Stimulus coincident = one_triangle(std::vector<Point>(1000, Point(0.25, 0.25, -1)));
  coincident.name = "coincident points";
  expect_brute_force(coincident);

  test::Random random(73);
  test::Stimulus far = test::bumpy_sphere(12, 16, 500, 73);
  far.name = "points 10^6 sizes away";
  for (int i = 0; i < 40; ++i) far.cloud.push_back(random.point(-1e6, 1e6));
  expect_brute_force(far);

  test::Stimulus far_vertex = test::bumpy_sphere(12, 16, 500, 74);
  far_vertex.name = "a vertex 10^6 sizes away";
  far_vertex.vertices[7] *= 1e6;
  expect_brute_force(far_vertex);
}

TEST(ErrorEngine, TakesAHundredThousandTimesTheSameTriangle) {
  test::Stimulus s = one_triangle({});
  test::Random random(75);
  for (int i = 0; i < 300; ++i) s.cloud.push_back(random.point(-1, 1));
  const BruteForce expected(s);
  s.triangles.assign(100000, s.triangles.front());
  const PreparedMesh mesh(s.mesh(), expected.cloud.normalization());
  ErrorEngine engine(expected.cloud);
  Tally tally;
  ask_everything(engine, mesh, expected, tally);
  EXPECT_EQ(tally.wrong, 0);
}

TEST(ErrorEngine, RefusesWhatCannotBeMeasured) {
  EXPECT_THROW(PreparedCloud(std::vector<Point>{}), std::invalid_argument);
  test::Stimulus s = test::bumpy_sphere(12, 16, 100, 76);
  const PreparedCloud cloud(s.cloud);
  EXPECT_THROW(PreparedMesh({s.vertices, {}}, cloud.normalization()), Error);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e300, 1e12}) {
    for (const EngineTarget& target : engine_targets()) {
      test::Stimulus broken = s;
      broken.vertices[broken.triangles[9][1]].y() = bad;
      try {
        const PreparedMesh mesh(broken.mesh(), cloud.normalization(), target);
        ADD_FAILURE() << bad << " was taken by " << target.name;
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("triangle "), std::string::npos) << error.what();
      }
    }
  }
  const PreparedMesh mesh(s.mesh(), cloud.normalization());
  EXPECT_THROW(ErrorEngine(cloud, {.threads = 0}), std::invalid_argument);
  ErrorEngine engine(cloud);
  EXPECT_THROW(engine.quantile(mesh, 0), std::invalid_argument);
  EXPECT_THROW(engine.quantile(mesh, 1.01), std::invalid_argument);
}

TEST(ErrorEngine, StopsWhenInterrupted) {
  const test::Stimulus s = test::bumpy_sphere(20, 30, 3000, 77);
  const PreparedCloud cloud(s.cloud);
  const PreparedMesh mesh(s.mesh(), cloud.normalization());
  EngineOptions options;
  options.interrupted = [] { return true; };
  ErrorEngine engine(cloud, options);
  EXPECT_THROW(engine.e_max(mesh), Interrupted);
  EXPECT_THROW(engine.squared_distances(mesh), Interrupted);
}

}  // namespace
}  // namespace emax
