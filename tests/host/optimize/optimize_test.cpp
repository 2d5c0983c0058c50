#include "host/optimize/optimize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "host/block_search/simd_evaluator.h"
#include "host/chain/chain.h"
#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/host/support/surfaces.h"
#include "tests/host/worker/test_methods.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kBudget = 24;
const RunSettings kSettings = {{"of", "the test"}};

// With this seed the first candidates, which depend on no result, meet every fault once.
std::uint64_t seed_of_every_fault(const Config& config) {
  for (std::uint64_t seed = 1;; ++seed) {
    Genocop search(make_problem(config, "schroeder.reduction"), config.search, seed);
    std::vector<int> count(8);
    for (std::size_t i = 0; i < config.search.look_ahead; ++i) {
      ++count[static_cast<std::size_t>(search.ask().genes.back())];
    }
    if (std::all_of(count.begin() + 1, count.begin() + 5, [](int n) { return n == 1; })) {
      return seed;
    }
  }
}

// A search on a small torus.
class OptimizeTest : public testing::Test {
 protected:
  explicit OptimizeTest(std::vector<Point> cloud = torus_cloud(30, 12), double epsilon = 0.3)
      : cloud_(std::move(cloud)), constraint_(cloud_, epsilon, 0) {
    settings_.decimator = "schroeder";
    settings_.config = default_config(chain_parameters("gp3", "schroeder"));
    settings_.config.search.budget = kBudget;
    settings_.config.search.monotone_walk = false;  // so that an evaluation is one mesh
    settings_.jobs = 2;
    settings_.limits = EvaluationLimits{60s, 0};
    settings_.output = "mesh.ply";
  }

  void with_faults() {
    settings_.config.genes.push_back(kFault.parameter());
    settings_.seed = seed_of_every_fault(settings_.config);
    settings_.worker = EMAX_TEST_WORKER;
    settings_.limits->time = 3s;
#ifndef EMAX_UNLIMITED_ADDRESS_SPACE
    settings_.limits->memory = std::uint64_t{1} << 28;
#endif
  }

  OptimizeState run(RunLog* log = nullptr) {
    settings_.log = log;
    measured_ = 0;
    settings_.measured = [this](MeshView, const MeasuredError&) { ++measured_; };
    return optimize(cloud_, constraint_, device_, settings_, [](const OptimizeState&) {});
  }

  std::filesystem::path copy_of_folder(const std::string& name) {
    std::filesystem::copy(path_, folder_ / name);
    return folder_ / name;
  }

  const std::vector<Point> cloud_;
  ErrorConstraint constraint_;
  Evaluator* device_ = nullptr;
  OptimizeSettings settings_;
  std::uint64_t measured_ = 0;  // meshes, by the last run
  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "run";
};

void expect_same(const OptimizeState& a, const OptimizeState& b) {
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.failures, b.failures);
  ASSERT_TRUE(a.best && b.best);
  EXPECT_EQ(a.best->index, b.best->index);
  EXPECT_EQ(a.best->chain.method, b.best->chain.method);
  EXPECT_EQ(a.best->chain.parameters, b.best->chain.parameters);
  EXPECT_EQ(a.best->error, b.best->error);
  EXPECT_EQ(a.best->unmeshed_points, b.best->unmeshed_points);
  EXPECT_TRUE(same_bytes(a.best->mesh, b.best->mesh));
  EXPECT_FALSE(a.best->mesh.triangles.empty());
}

// Every fault costs its evaluation and no more, whoever runs it and whenever; what the search was
// told of it stands when the run goes on.
TEST_F(OptimizeTest, FaultyWorkersCostTheirEvaluationsAndAreLogged) {
  with_faults();
  OptimizeState whole;
  {
    RunLog log(path_, kSettings);
    whole = run(&log);
  }
  ASSERT_TRUE(whole.best);
  EXPECT_EQ(whole.evaluations, kBudget);
  std::uint64_t failed = 0;
  for (const auto& [reason, count] : whole.failures) failed += count;
  EXPECT_EQ(failed + measured_, kBudget);
  for (const char* reason : {"crashed", "timed out", "out of memory", "garbled"}) {
    EXPECT_GE(whole.failures[reason], 1u) << reason;
  }

  // Cut somewhere, with another number of workers, and even with ones that fail no more.
  const std::uintmax_t size = std::filesystem::file_size(path_ / "evaluations.log");
  const std::filesystem::path all = copy_of_folder("all");
  Random random(9);
  for (unsigned jobs = 1; jobs <= 2; ++jobs) {
    const auto at =
        static_cast<std::uintmax_t>(random.uniform(0.85, 1) * static_cast<double>(size));
    SCOPED_TRACE(testing::Message() << "cut at " << at << " of " << size);
    std::filesystem::resize_file(path_ / "evaluations.log", at);
    settings_.jobs = jobs;
    RunLog log(path_, kSettings);
    const std::size_t known = log.size();
    EXPECT_GT(known, 0u);
    const OptimizeState rest = run(&log);
    expect_same(rest, whole);
    EXPECT_EQ(rest.from_log, known);
    EXPECT_LE(measured_, kBudget - known);
  }
  settings_.worker.clear();
  RunLog log(all, kSettings);
  expect_same(run(&log), whole);
  EXPECT_EQ(measured_, 0u);
}

TEST_F(OptimizeTest, AnInterruptedRunGoesOnToTheSameEnd) {
  const OptimizeState whole = run();
  EXPECT_TRUE(whole.failures.empty());
  constexpr std::uint64_t kEach = 6;
  for (std::uint64_t session = 1; session <= 3; ++session) {
    settings_.interrupted = [this] { return measured_ >= kEach; };
    RunLog log(path_, kSettings);
    const OptimizeState cut = run(&log);
    EXPECT_TRUE(cut.interrupted);
    ASSERT_TRUE(cut.best || cut.least_error);  // shown, whether made now or earlier
    EXPECT_FALSE((cut.best ? cut.best : cut.least_error)->mesh.triangles.empty());
    EXPECT_GE(log.size(), session * kEach);
    std::filesystem::remove_all(folder_ / "copy");
    settings_.interrupted = [] { return false; };
    RunLog copy(copy_of_folder("copy"), kSettings);
    expect_same(run(&copy), whole);
  }
}

// The twin looks at the log of the whole run.
TEST_F(OptimizeTest, StopsAtTheSameEvaluationHoweverItIsRun) {
  std::vector<LoggedEvaluation> evaluations(kBudget);
  {
    RunLog log(path_, kSettings);
    run(&log);
    for (std::uint64_t i = 0; i < kBudget; ++i) {
      if (const LoggedEvaluation* known = log.find(i)) evaluations[i] = *known;
      if (log.find(i) == nullptr) evaluations[i].failure = "repeated";
    }
  }
  const auto expected_end = [&](std::uint64_t target, std::uint64_t stagnation) {
    std::uint64_t best = ~std::uint64_t{0}, error = best, better = 0;
    for (std::uint64_t i = 0; i < kBudget; ++i) {
      const LoggedEvaluation& e = evaluations[i];
      if (e.failure.empty()) {
        if (e.violation() <= 0 && e.triangles < best) {
          best = e.triangles;
          better = i + 1;
        } else if (e.violation() > 0 && best == ~std::uint64_t{0} && e.squared_bits < error) {
          error = e.squared_bits;
          better = i + 1;
        }
      }
      if (best <= target || i + 1 - better >= stagnation) return i + 1;
    }
    return kBudget;
  };
  std::set<std::uint64_t> ends;
  const auto check = [&](std::optional<std::uint64_t> target,
                         std::optional<std::uint64_t> stagnation) {
    SCOPED_TRACE(testing::Message() << target.value_or(0) << " " << stagnation.value_or(0));
    settings_.target_triangles = target;
    settings_.stagnation = stagnation;
    const std::uint64_t end = expected_end(target.value_or(0), stagnation.value_or(kBudget + 1));
    ends.insert(end);
    settings_.jobs = 2;
    const OptimizeState fresh = run();
    EXPECT_EQ(fresh.evaluations, end);
    EXPECT_EQ(fresh.target_reached, target && fresh.best && fresh.best->triangles <= *target);
    if (end < kBudget) {
      EXPECT_TRUE(fresh.target_reached || fresh.stagnated);
    }
    // From the log of the whole run, whose folder has the mesh of another evaluation.
    settings_.jobs = 1;
    std::filesystem::remove_all(folder_ / "copy");
    RunLog log(copy_of_folder("copy"), kSettings);
    expect_same(run(&log), fresh);
    EXPECT_EQ(measured_, 0u);
  };
  check({}, 3);
  check({}, 6);
  for (const std::uint64_t i : {2u, 9u}) {
    if (evaluations[i].failure.empty()) check(evaluations[i].triangles, {});
  }
  EXPECT_GE(ends.size(), 2u);
}

// The twin looks at the log.
TEST_F(OptimizeTest, TellsWhenItHadFewerTriangles) {
  settings_.begun -= 100s;
  RunLog log(path_, kSettings);
  const OptimizeState whole = run(&log);
  std::vector<FewerTriangles> expected;
  double latest = 100;
  for (const auto& [index, e] : log.evaluations()) {
    EXPECT_GE(e.seconds, 100) << index;
    if (!e.failure.empty() || e.violation() > 0) continue;
    if (!expected.empty() && e.triangles >= expected.back().triangles) continue;
    latest = std::max(latest, e.seconds);
    expected.push_back({latest, e.triangles});
  }
  EXPECT_GE(expected.size(), 2u);
  EXPECT_EQ(whole.course, expected);
  EXPECT_EQ(run(&log).course, expected);

  // What a later command finds comes behind what was known.
  settings_.config.search.earlier_budgets = {kBudget};
  settings_.config.search.budget = kBudget + 2;
  run(&log);
  const auto& [index, later] = *log.evaluations().rbegin();
  EXPECT_GE(index, kBudget);
  EXPECT_GE(later.seconds, 100 + latest);
}

TEST_F(OptimizeTest, AMeshThatIsLostIsMadeAgain) {
  RunLog log(path_, kSettings);
  const OptimizeState whole = run(&log);
  const std::string name = "mesh-" + std::to_string(whole.best->index) + ".ply";
  std::vector<std::string> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    if (entry.path().extension() == ".ply") meshes.push_back(entry.path().filename().string());
  }
  EXPECT_EQ(meshes, std::vector<std::string>{name});  // the best alone is kept
  std::string bytes = bytes_of(path_ / name);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  folder_.write("run/" + name, bytes);
  expect_same(run(&log), whole);
  std::filesystem::remove(path_ / name);
  expect_same(run(&log), whole);
}

// Lets its worker begin when the search stops it, so that no evaluation completes before.
class PoolThatWaitsForTheStop final : public EvaluationPool {
 public:
  explicit PoolThatWaitsForTheStop(std::unique_ptr<EvaluationPool> pool) : pool_(std::move(pool)) {}

  void submit(RunMessage run) override { queue_.push_back(std::move(run)); }
  std::optional<Completed> wait_for(std::chrono::milliseconds) override {
    return std::exchange(completed_, {});
  }
  void go_on() override {}
  void stop() override {
    if (queue_.empty()) return;
    pool_->submit(std::move(queue_.front()));
    queue_.clear();
    pool_->stop();
    while (!completed_) completed_ = pool_->wait_for(1s);
  }
  std::size_t outstanding() const override { return queue_.size() + (completed_ ? 1 : 0); }

 private:
  const std::unique_ptr<EvaluationPool> pool_;
  std::vector<RunMessage> queue_;
  std::optional<Completed> completed_;
};

// Out of time, what is decimated gives the mesh at hand, which may be the result, but is no result
// of its candidate: the run goes on to the same end as one that was not cut short.
TEST_F(OptimizeTest, OutOfTimeTakesTheMeshesAtHand) {
  settings_.decimator = "bounded";
  settings_.config = default_config(chain_parameters("gp3", "bounded"));
  settings_.config.search.budget = 3;
  settings_.bound.epsilon = 0.05;
  settings_.jobs = 1;
  const OptimizeState whole = run();
  EXPECT_EQ(whole.stopped, 0u);

  // Before anything was evaluated.
  settings_.polish = false;
  bool handed_out = false;
  settings_.seconds_left = [&] { return handed_out ? 0 : 1e9; };
  settings_.make_pool = [](auto... arguments) {
    return std::make_unique<PoolThatWaitsForTheStop>(make_worker_pool(arguments...));
  };
  RunLog log(path_, kSettings);
  settings_.log = &log;
  const OptimizeState cut = optimize(cloud_, constraint_, device_, settings_,
                                     [&](const OptimizeState&) { handed_out = true; });
  EXPECT_TRUE(cut.out_of_time);
  EXPECT_EQ(cut.stopped, 1u);
  EXPECT_EQ(cut.evaluations, 0u);
  ASSERT_TRUE(cut.best);
  EXPECT_TRUE(log.find(cut.best->index)->stopped);
  EXPECT_FALSE(cut.best->mesh.triangles.empty());

  // As an earlier process left it.
  const OptimizeState again = run(&log);
  EXPECT_EQ(again.evaluations, 0u);
  ASSERT_TRUE(again.best);
  EXPECT_TRUE(same_bytes(again.best->mesh, cut.best->mesh));

  settings_.make_pool = make_worker_pool;
  settings_.polish = true;
  settings_.seconds_left = [] { return HUGE_VAL; };
  expect_same(run(&log), whole);
  for (const auto& [index, e] : log.evaluations()) EXPECT_FALSE(e.stopped) << index;
}

// Every evaluation looks for the greatest reduction itself; the twin tries each of a hundred.
TEST_F(OptimizeTest, AnEvaluationWalksTheReduction) {
  settings_.config.search.monotone_walk = true;
  settings_.config.search.budget = 1;
  RunLog log(path_, kSettings);
  const OptimizeState state = run(&log);
  ASSERT_TRUE(state.best);
  EXPECT_GT(measured_, 1u);
  EXPECT_EQ(log.evaluations().size(), 1u);
  const double walked = state.best->chain.parameters.at(Schroeder::kReduction);
  EXPECT_EQ(log.find(0)->walked, walked);
  Chain chain(cloud_);
  ChainSettings candidate = state.best->chain;
  EXPECT_TRUE(same_bytes(as_stored(chain.run(candidate).mesh, Storage::kExact), state.best->mesh));
  std::size_t fewest = state.best->triangles;
  for (int i = 0; i < 100; ++i) {
    candidate.parameters.set(Schroeder::kReduction, 0.98 * i / 100);
    const TriangleMesh mesh = chain.run(candidate).mesh;
    if (constraint_.measure(mesh.view()).feasible) fewest = std::min(fewest, mesh.triangles.size());
  }
  EXPECT_LE(static_cast<double>(state.best->triangles), 1.2 * static_cast<double>(fewest));
}

// A surface that misses points before it is decimated is hopeless: it costs one mesh, and tells how
// far it is from hope.
TEST_F(OptimizeTest, AFloorThatBreaksTheBoundIsToldAtOnce) {
  settings_.config.search.monotone_walk = true;
  settings_.config.search.budget = 4;
  std::uint64_t meshes = 0;
  settings_.measured = [&](MeshView, const MeasuredError&) { ++meshes; };
  std::vector<Point> cloud = cloud_;
  cloud.push_back({9, 9, 9});  // no neighbour is near enough
  ErrorConstraint constraint(cloud, 0.3, 0);
  const OptimizeState state =
      optimize(cloud, constraint, nullptr, settings_, [](const OptimizeState&) {});
  EXPECT_FALSE(state.best);
  ASSERT_TRUE(state.least_error);
  EXPECT_EQ(meshes, 4u);
  EXPECT_EQ(state.least_error->chain.parameters.at(Schroeder::kReduction), 0);
}

TEST_F(OptimizeTest, WalksAreTheSameForAnyJobsAndGoOnFromTheLog) {
  settings_.config.search.monotone_walk = true;
  settings_.config.search.budget = 20;
  const OptimizeState whole = run();
  settings_.jobs = 1;
  RunLog log(path_, kSettings);
  settings_.interrupted = [this] { return measured_ >= 30; };
  EXPECT_TRUE(run(&log).interrupted);
  EXPECT_GT(log.size(), 0u);
  EXPECT_LT(log.size(), 20u);
  settings_.interrupted = [] { return false; };
  expect_same(run(&log), whole);
}

// As when the libraries have changed although the settings name the same.
TEST_F(OptimizeTest, AMeshThatIsMadeAgainMustBeTheSame) {
  std::uint64_t best = 0;
  {
    RunLog log(path_, kSettings);
    best = run(&log).best->index;
  }
  RunLog log(path_, kSettings);
  LoggedEvaluation other = *log.find(best);
  other.squared_bits ^= 1;
  log.append(other);
  std::filesystem::remove(path_ / ("mesh-" + std::to_string(best) + ".ply"));
  EXPECT_THROW(run(&log), Error);
}

// Before the first reconstruction; a candidate's own vertices cost that candidate.
TEST_F(OptimizeTest, RefusesAFormatThatRoundsTooMuch) {
  settings_.output = "mesh.stl";
  EXPECT_TRUE(run().best);
  std::vector<Point> far = cloud_;
  for (Point& p : far) p.x() += 1e8;
  ErrorConstraint constraint(far, 0.3, 0);
  int observed = 0;
  EXPECT_THROW(optimize(far, constraint, nullptr, settings_, [&](auto&&) { ++observed; }), Error);
  EXPECT_EQ(observed, 0);
}

// On a torus of which more than the 400 triangles are left below which every effort is deep.
class DeepOptimizeTest : public OptimizeTest {
 protected:
  DeepOptimizeTest() : OptimizeTest(torus_cloud(60, 24), kEpsilon) {
    settings_.bound.epsilon = constraint_.provable_distance();  // deep meshes come as near as that
  }
  static constexpr double kEpsilon = 0.005;
};

// Both decimators as categories: what is found is either's, and only the bounded one goes deep.
TEST_F(DeepOptimizeTest, TheDecimatorMayBeAGene) {
  settings_.decimator = "auto";
  settings_.config = default_config(chain_parameters("gp3", "auto"));
  settings_.config.search.budget = kBudget;
  std::set<std::string> decimators;
  RunLog log(path_, kSettings);
  const OptimizeState state = run(&log);
  ASSERT_TRUE(state.best);
  const Problem problem = search_problem(settings_);
  for (const auto& [index, e] : log.evaluations()) {
    decimators.insert(chain_of(settings_, problem, e.genes).decimator);
  }
  EXPECT_EQ(decimators.size(), 2u);
  EXPECT_EQ(state.best->chain.decimator, "bounded");
  EXPECT_EQ(state.best->chain.parameters.at(Bounded::kEffort), Bounded::kDeepEffort);

  const auto gene = std::ranges::find(settings_.config.genes, "decimator", &Parameter::name);
  gene->fixed = 1;
  const OptimizeState paper = run();
  ASSERT_TRUE(paper.best);
  EXPECT_EQ(paper.best->chain.decimator, "schroeder");
  EXPECT_FALSE(paper.polished);
}

// A candidate whose decimation will not end below the best known ends early, and is told as what it
// would have come to. The twin decimates each of these to the end.
TEST_F(DeepOptimizeTest, CandidatesThatCannotBeTheBestEndEarly) {
  settings_.decimator = "bounded";
  settings_.config = default_config(chain_parameters("gp3", "bounded"));
  settings_.config.search.budget = 16;
  settings_.config.search.look_ahead = 2;
  settings_.polish = false;
  RunLog log(path_, kSettings);
  const OptimizeState state = run(&log);
  EXPECT_GT(state.outpaced, 0u);
  std::uint64_t outpaced = 0;
  for (const auto& [index, e] : log.evaluations()) {
    if (!e.expected_triangles) continue;
    ++outpaced;
    EXPECT_NE(index % 4, 0u);
    EXPECT_GT(e.triangles, state.best->triangles);
    const ChainSettings candidate = chain_of(settings_, search_problem(settings_), e.genes);
    const ChainResult whole = Chain(cloud_, settings_.bound, 1 << 20).run(candidate);
    EXPECT_GE(whole.mesh.triangles.size(), state.best->triangles) << index;
  }
  EXPECT_EQ(outpaced, state.outpaced);

  settings_.jobs = 1;
  const OptimizeState alone = run();
  expect_same(alone, state);
  EXPECT_EQ(alone.outpaced, state.outpaced);
  settings_.interrupted = [this] { return measured_ >= 8; };
  RunLog cut(folder_ / "cut", kSettings);
  EXPECT_TRUE(run(&cut).interrupted);
  settings_.interrupted = [] { return false; };
  const OptimizeState rest = run(&cut);
  expect_same(rest, state);
  EXPECT_EQ(rest.outpaced, state.outpaced);
}

// A search over a noisy cube that is its own reference.
class PlanesOptimizeTest : public OptimizeTest {
 protected:
  static TriangleMesh rough_cube() {
    TriangleMesh mesh = cube(12);
    Random random(named_seed("cube of a search", 1));
    for (Point& v : mesh.vertices) v += random.point(-0.006, 0.006);
    return mesh;
  }
  PlanesOptimizeTest() : OptimizeTest(rough_cube().vertices, kEpsilon) {
    settings_.method = kFitMethod;
    settings_.decimator = "bounded";
    settings_.features = kAutoFeatures;
    settings_.config = default_config(chain_parameters(kFitMethod, "bounded", kAutoFeatures));
    settings_.config.search.budget = 6;
    settings_.polish = false;
    settings_.epsilon_back = kEpsilon;
    settings_.bound = {constraint_.provable_distance(), kEpsilon, rough_cube(), {}};
  }
  static constexpr double kEpsilon = 0.03;

  static bool on_planes(const ChainSettings& chain) {
    return !features_key(chain).by_name().empty();
  }
};

// The twin is a worker's chain.
TEST_F(PlanesOptimizeTest, ThePlanesAreAGene) {
  RunLog log(path_, kSettings);
  const OptimizeState whole = run(&log);
  ASSERT_TRUE(whole.best);
  const Problem problem = search_problem(settings_);
  Chain chain(cloud_, settings_.bound);
  std::size_t fewest = ~std::size_t{0}, with = 0;
  for (const auto& [index, e] : log.evaluations()) {
    const ChainSettings candidate = chain_of(settings_, problem, e.genes);
    if (index < 2) {
      EXPECT_EQ(on_planes(candidate), index == 0);
    }
    EXPECT_EQ(chain.run(candidate).mesh.triangles.size(), e.triangles) << index;
    fewest = std::min(fewest, static_cast<std::size_t>(e.triangles));
    with += on_planes(candidate) ? 1 : 0;
  }
  EXPECT_EQ(whole.best->triangles, fewest);
  EXPECT_GT(with, 0u);
  EXPECT_LT(with, log.evaluations().size());

  settings_.jobs = 1;
  expect_same(run(), whole);
  settings_.interrupted = [this] { return measured_ >= 3; };
  RunLog cut(folder_ / "cut", kSettings);
  EXPECT_TRUE(run(&cut).interrupted);
  settings_.interrupted = [] { return false; };
  expect_same(run(&cut), whole);
}

TEST_F(PlanesOptimizeTest, MayAlwaysFollowThem) {
  settings_.features = kOnPlanes;
  settings_.config = default_config(chain_parameters(kFitMethod, "bounded", kOnPlanes));
  settings_.config.search.budget = 3;
  RunLog log(path_, kSettings);
  run(&log);
  EXPECT_EQ(log.evaluations().size(), 3u);
  for (const auto& [index, e] : log.evaluations()) {
    EXPECT_TRUE(on_planes(chain_of(settings_, search_problem(settings_), e.genes))) << index;
  }
}

// The twin is a worker's chain, run here with the parameters of all three.
TEST_F(DeepOptimizeTest, TheBestAreDecimatedDeepInTheEnd) {
  settings_.decimator = "bounded";
  settings_.config = default_config(chain_parameters("gp3", "bounded"));
  settings_.config.search.budget = 3;
  settings_.polish = false;
  OptimizeState plain;
  std::vector<LoggedEvaluation> ranked;
  {
    RunLog log(folder_ / "plain", kSettings);
    plain = run(&log);
    for (const auto& [index, e] : log.evaluations()) ranked.push_back(e);
  }
  ASSERT_TRUE(plain.best);
  EXPECT_FALSE(plain.polished);
  std::ranges::stable_sort(ranked, {}, &LoggedEvaluation::triangles);
  TriangleMesh twin;
  ChainSettings deep;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_LE(ranked.at(i).violation(), 0);
    ChainSettings candidate = chain_of(settings_, search_problem(settings_), ranked[i].genes);
    EXPECT_EQ(candidate.parameters.at(Bounded::kEffort), 2);
    candidate.parameters.set(Bounded::kEffort, Bounded::kDeepEffort);
    TriangleMesh made = Chain(cloud_, settings_.bound, 1 << 20).run(candidate).mesh;
    if (i > 0 && made.triangles.size() >= twin.triangles.size()) continue;
    twin = std::move(made);
    deep = candidate;
  }
  ASSERT_LT(twin.triangles.size(), plain.best->triangles);

  settings_.polish = true;
  const OptimizeState whole = run();
  EXPECT_EQ(whole.polished, plain.best->triangles);
  EXPECT_TRUE(same_bytes(whole.best->mesh, as_stored(twin, Storage::kExact)));
  EXPECT_EQ(whole.best->chain.parameters, deep.parameters);
  EXPECT_EQ(whole.evaluations, plain.evaluations);

  // Cut short in the middle of it, and gone on with.
  RunLog log(path_, kSettings);
  bool interrupted = false;
  settings_.log = &log;
  settings_.interrupted = [&] { return interrupted; };
  const OptimizeState cut =
      optimize(cloud_, constraint_, device_, settings_,
               [&](const OptimizeState& state) { interrupted = state.polishing; });
  EXPECT_TRUE(cut.interrupted);
  EXPECT_TRUE(same_bytes(cut.best->mesh, plain.best->mesh));
  interrupted = false;
  expect_same(run(&log), whole);
  EXPECT_EQ(measured_, 3u);
  expect_same(run(&log), whole);
  EXPECT_EQ(measured_, 0u);

  // Cut short later, it is no evaluation more; one that failed or gained nothing is said to.
  interrupted = true;
  EXPECT_EQ(run(&log).evaluations, settings_.config.search.budget);
  interrupted = false;
  const std::vector<LoggedEvaluation> made = {*log.find(kPolishIndex), *log.find(kPolishIndex + 1),
                                              *log.find(kPolishIndex + 2)};
  for (LoggedEvaluation in_vain : made) {
    in_vain.triangles = plain.best->triangles;
    log.append(in_vain);
  }
  const OptimizeState same = run(&log);
  EXPECT_EQ(same.polished, plain.best->triangles);
  EXPECT_TRUE(same_bytes(same.best->mesh, plain.best->mesh));
  for (const LoggedEvaluation& e : made) {
    LoggedEvaluation failed;
    failed.index = e.index;
    failed.genes = e.genes;
    failed.failure = "timed out";
    log.append(failed);
  }
  const OptimizeState without = run(&log);
  EXPECT_FALSE(without.polished);
  EXPECT_EQ(without.failures.at("timed out"), 3u);

  // Not where enough was found, and anew where another is the best.
  settings_.target_triangles = plain.best->triangles;
  EXPECT_FALSE(run(&log).polished);
  settings_.target_triangles.reset();
  for (LoggedEvaluation other : made) {
    other.genes.front() += 1;
    log.append(other);
  }
  expect_same(run(&log), whole);
  EXPECT_EQ(measured_, 3u);
}

TEST_F(OptimizeTest, RefusesTheLogOfAnotherSearch) {
  settings_.config.search.budget = 3;
  RunLog log(path_, kSettings);
  run(&log);
  settings_.config.genes[0].standard += 1;
  expect_clear(message_of([&] { run(&log); }), path_.string(), "evaluation 0 has other parameters",
               "another folder");
}

// What a device fails at is no candidate's fault.
TEST_F(OptimizeTest, AFailedDeviceIsNotLogged) {
  struct Failing : SimdEvaluator {
    BlockAnswer collect() override {
      if (++blocks > 40) throw DeviceFailure("the board is unplugged");
      return SimdEvaluator::collect();
    }
    int blocks = 0;
  };
  const OptimizeState whole = run();
  RunLog log(path_, kSettings);
  Failing failing;
  device_ = &failing;
  const OptimizeState cut = run(&log);
  EXPECT_EQ(cut.device_failure, "the board is unplugged");
  EXPECT_GT(log.size(), 0u);
  EXPECT_LT(log.size(), kBudget);
  EXPECT_TRUE(cut.failures.empty());
  device_ = nullptr;
  expect_same(run(&log), whole);
}

}  // namespace
}  // namespace emax::test
