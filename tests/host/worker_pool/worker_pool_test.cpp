#include "host/worker_pool/worker_pool.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <utility>

#include "host/parameters/registry.h"
#include "sw_model/base/error.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

using namespace std::chrono_literals;

ChainSettings settings(const std::string& method) {
  ChainSettings result{method, "schroeder", ParameterValues(chain_parameters(method, "schroeder"))};
  if (method == "hoppe") result.parameters.set(Hoppe::kResolution, 32);
  if (method == "poisson") result.parameters.set(Poisson::kDepth, 6);
  return result;
}

ChainSettings failing(const std::string& method) { return {method, "schroeder", {}}; }

WorkerPoolOptions options(unsigned jobs) {
  WorkerPoolOptions result;
  result.jobs = jobs;
  result.time_limit = 60s;
  result.program = EMAX_TEST_WORKER;
  return result;
}

std::map<std::uint64_t, ChainResult> evaluate(unsigned jobs,
                                              const std::vector<ChainSettings>& candidates) {
  const std::vector<Point> cloud = torus_cloud(40, 18);
  WorkerPool pool(cloud, options(jobs));
  for (std::size_t i = 0; i < candidates.size(); ++i) pool.submit(i, candidates[i]);
  EXPECT_EQ(pool.outstanding(), candidates.size());
  std::map<std::uint64_t, ChainResult> results;
  while (pool.outstanding() > 0) {
    Completed completed = pool.wait();
    if (const auto* failure = std::get_if<Failure>(&completed.outcome)) {
      ADD_FAILURE() << failure->message;
      continue;
    }
    results[completed.ticket] = std::get<ChainResult>(std::move(completed.outcome));
  }
  return results;
}

// A failure, then a sound evaluation by the same pool.
Failure failure_of(const std::string& method, WorkerPoolOptions pool_options) {
  WorkerPool pool(torus_cloud(30, 12), pool_options);
  pool.submit(5, failing(method));
  pool.submit(6, settings("gp3"));
  const Completed failed = pool.wait();
  EXPECT_EQ(failed.ticket, 5u);
  const Completed sound = pool.wait();
  EXPECT_EQ(sound.ticket, 6u);
  EXPECT_TRUE(std::holds_alternative<ChainResult>(sound.outcome));
  EXPECT_EQ(pool.outstanding(), 0u);
  return std::get<Failure>(failed.outcome);
}

TEST(WorkerPool, GivesTheSameMeshesForAnyNumberOfJobs) {
  std::vector<ChainSettings> candidates;
  for (int i = 0; i < 8; ++i) {
    candidates.push_back(settings(i % 4 == 3 ? "hoppe" : "gp3"));
    candidates.back().parameters.set(Schroeder::kReduction, 0.3 + 0.05 * i);
    candidates.back().parameters.set(Normals::kNeighbours, i < 4 ? 10 : 12);
  }
  const auto one = evaluate(1, candidates);
  const auto two = evaluate(2, candidates);
  ASSERT_EQ(one.size(), candidates.size());
  ASSERT_EQ(two.size(), candidates.size());
  for (const auto& [ticket, result] : one) {
    EXPECT_TRUE(same_bytes(result.mesh, two.at(ticket).mesh)) << ticket;
    EXPECT_EQ(result.reconstruction_triangles, two.at(ticket).reconstruction_triangles);
    EXPECT_EQ(result.unmeshed_points, two.at(ticket).unmeshed_points);
  }
}

// No more threads than the pool may have workers; they change no byte.
TEST(WorkerPool, GivesAnEvaluationSeveralThreads) {
  const std::vector<Point> cloud = torus_cloud(60, 30);
  const ChainSettings bounded{"gp3", "bounded",
                              ParameterValues(chain_parameters("gp3", "bounded"))};
  std::optional<ChainResult> one;
  for (const auto& [jobs, threads] : {std::pair{1u, 1u}, {3u, 3u}, {2u, 100u}}) {
    WorkerPoolOptions few = options(jobs);
    few.memory_limit = std::uint64_t{1} << 31;
    WorkerPool pool(cloud, {0.05, 0, {}, {}}, few);
    pool.submit({7, bounded, 0, threads});
    const ChainResult result = std::get<ChainResult>(pool.wait().outcome);
    if (one) {
      EXPECT_TRUE(same_bytes(result.mesh, one->mesh)) << jobs;
    } else {
      one = result;
    }
  }
}

// A decimation that is stopped gives the mesh at hand, and its worker goes on as if nothing had
// been; one that has answered, or that nobody decimates, hears nothing of it.
TEST(WorkerPool, StopsADecimationWithItsMesh) {
  const std::vector<Point> cloud = torus_cloud(60, 30);
  ChainSettings bounded{"gp3", "bounded", ParameterValues(chain_parameters("gp3", "bounded"))};
  WorkerPool pool(cloud, {0.05, 0, {}, {}}, options(1));
  const auto next = [&pool] { return std::get<ChainResult>(pool.wait().outcome); };
  pool.submit(0, bounded);
  const ChainResult whole = next();
  EXPECT_FALSE(whole.stopped);
  pool.stop();  // which has nothing to do

  bounded.parameters.set(Bounded::kFlatness, 2e-3);
  pool.submit(1, bounded);
  pool.submit(2, bounded);
  pool.stop();
  EXPECT_EQ(pool.outstanding(), 1u);  // what was queued is given up
  const ChainResult stopped = next();
  EXPECT_TRUE(stopped.stopped);
  EXPECT_GT(stopped.mesh.triangles.size(), whole.mesh.triangles.size());

  bounded.parameters.set(Bounded::kFlatness, 1e-3);
  pool.submit(3, bounded);
  EXPECT_TRUE(same_bytes(next().mesh, whole.mesh));

  pool.submit(4, settings("gp3"));
  pool.stop();
  EXPECT_FALSE(next().stopped);
}

// No process may run it twice: a worker that has goes on with what it made, or is replaced.
TEST(WorkerPool, RunsPoissonAgainAndAgain) {
  ChainSettings other = settings("poisson");
  other.parameters.set(Poisson::kScale, 1.2);
  const auto results = evaluate(1, {settings("poisson"), other, settings("gp3"), other,
                                    settings("poisson"), settings("poisson")});
  ASSERT_EQ(results.size(), 6u);
  EXPECT_TRUE(same_bytes(results.at(0).mesh, results.at(4).mesh));
  EXPECT_TRUE(same_bytes(results.at(0).mesh, results.at(5).mesh));
  EXPECT_TRUE(same_bytes(results.at(1).mesh, results.at(3).mesh));
  EXPECT_FALSE(same_bytes(results.at(0).mesh, results.at(1).mesh));
  // Whatever the order they were handed out in, each was reconstructed once.
  std::size_t made = 0;
  for (const auto& [ticket, result] : results) made += result.seconds.reconstruct > 0 ? 1 : 0;
  EXPECT_EQ(made, 3u);
}

// Candidates that differ in decimation alone go where their reconstruction is kept.
TEST(WorkerPool, GivesCandidatesToTheWorkerThatHasTheirReconstruction) {
  std::vector<ChainSettings> candidates;
  for (int i = 0; i < 8; ++i) {
    candidates.push_back(settings(i % 2 == 0 ? "gp3" : "hoppe"));
    candidates.back().parameters.set(Schroeder::kReduction, 0.1 * i);
  }
  std::size_t made = 0;
  for (const auto& [ticket, result] : evaluate(2, candidates)) {
    made += result.seconds.reconstruct > 0 ? 1 : 0;
  }
  EXPECT_LE(made, 3u);  // at the end a free worker takes what another has
}

TEST(WorkerPool, ReportsACrash) {
  const Failure failure = failure_of("test.crash", options(1));
  EXPECT_EQ(failure.reason, FailureReason::kCrashed);
  EXPECT_NE(failure.message.find("signal 6"), std::string::npos) << failure.message;
}

TEST(WorkerPool, ReportsAnExit) {
  const Failure failure = failure_of("test.exit", options(1));
  EXPECT_EQ(failure.reason, FailureReason::kCrashed);
  EXPECT_NE(failure.message.find("exit code 3"), std::string::npos) << failure.message;
}

TEST(WorkerPool, EndsAHangByItsTimeLimit) {
  WorkerPoolOptions impatient = options(1);
  impatient.time_limit = 3s;
  const auto start = std::chrono::steady_clock::now();
  const Failure failure = failure_of("test.hang", impatient);
  EXPECT_EQ(failure.reason, FailureReason::kTimedOut);
  EXPECT_NE(failure.message.find("longer than 3 s"), std::string::npos) << failure.message;
  EXPECT_GE(std::chrono::steady_clock::now() - start, 3s);
}

TEST(WorkerPool, EndsAnAnswerThatNeverEnds) {
  WorkerPoolOptions impatient = options(1);
  impatient.time_limit = 1s;
  EXPECT_EQ(failure_of("test.trickle", impatient).reason, FailureReason::kTimedOut);
}

TEST(WorkerPool, RefusesRubbish) {
  for (const std::string method :
       {"test.garbage", "test.huge", "test.strange", "test.nested", "test.flood"}) {
    const Failure failure = failure_of(method, options(1));
    EXPECT_EQ(failure.reason, FailureReason::kGarbled) << method << ": " << failure.message;
  }
}

TEST(WorkerPool, HandsOnTheErrorsOfTheChain) {
  const Failure failure = failure_of("test.error", options(1));
  EXPECT_EQ(failure.reason, FailureReason::kError);
  EXPECT_NE(failure.message.find("an error on purpose"), std::string::npos) << failure.message;
}

#ifndef EMAX_UNLIMITED_ADDRESS_SPACE  // whose own address space is larger than any limit
TEST(WorkerPool, HoldsAWorkerToItsMemoryLimit) {
  WorkerPoolOptions small = options(1);
  small.memory_limit = std::uint64_t{1} << 30;
  EXPECT_EQ(failure_of("test.memory", small).reason, FailureReason::kOutOfMemory);
}

TEST(WorkerPool, NamesAMemoryLimitTooSmallToStart) {
  const std::vector<Point> small = torus_cloud(30, 12), large(3'000'000, Point(1, 2, 3));
  // For the libraries, and for the cloud beside them.
  for (const auto& [cloud, megabytes] : {std::pair(small, 1), std::pair(large, 260)}) {
    WorkerPoolOptions tiny = options(1);
    tiny.memory_limit = static_cast<std::uint64_t>(megabytes) << 20;
    WorkerPool pool(cloud, tiny);
    pool.submit(1, settings("gp3"));
    std::string message;
    try {
      pool.wait();
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_NE(message.find("raise the memory limit"), std::string::npos) << message;
    EXPECT_EQ(message.find("before it was ready") == std::string::npos, megabytes > 1) << message;
  }
}
#endif

// Its worker's own past must not count.
TEST(WorkerPool, TriesAgainInAFreshWorkerWhatLacksMemory) {
  WorkerPool pool(torus_cloud(30, 12), options(1));
  pool.submit(1, settings("gp3"));
  pool.submit(2, failing("test.full"));
  EXPECT_TRUE(std::holds_alternative<ChainResult>(pool.wait().outcome));
  const Completed tried = pool.wait();
  const Failure& failure = std::get<Failure>(tried.outcome);
  EXPECT_EQ(failure.reason, FailureReason::kError) << failure.message;
  EXPECT_NE(failure.message.find("no reconstruction method"), std::string::npos);
}

// A library that gets no memory may crash; what crashes in a fresh worker too is given up.
TEST(WorkerPool, TriesAgainInAFreshWorkerWhatCrashes) {
  for (const auto& [fault, reason] : {std::pair("test.null", FailureReason::kError),
                                      std::pair("test.crash", FailureReason::kCrashed)}) {
    WorkerPool pool(torus_cloud(30, 12), options(1));
    pool.submit(1, settings("gp3"));
    pool.submit(2, failing(fault));
    EXPECT_TRUE(std::holds_alternative<ChainResult>(pool.wait().outcome));
    const Completed tried = pool.wait();
    EXPECT_EQ(std::get<Failure>(tried.outcome).reason, reason) << fault;
  }
}

// A sound evaluation goes on beside a hanging one, and wait_for comes back from it.
TEST(WorkerPool, WaitsNoLongerThanAsked) {
  WorkerPool pool(torus_cloud(30, 12), options(2));
  pool.submit(1, failing("test.hang"));
  pool.submit(2, settings("gp3"));
  EXPECT_EQ(pool.wait().ticket, 2u);
  EXPECT_FALSE(pool.wait_for(50ms).has_value());
  EXPECT_EQ(pool.outstanding(), 1u);
}

TEST(WorkerPool, HasNothingToWaitForWhenNothingWasSubmitted) {
  WorkerPool pool(torus_cloud(30, 12), options(1));
  EXPECT_THROW(pool.wait(), Error);
}

}  // namespace
}  // namespace emax::test
