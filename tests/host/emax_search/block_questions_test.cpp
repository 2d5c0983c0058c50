#include "host/emax_search/block_questions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "host/device/device_address.h"
#include "host/emax_search/simd_evaluator.h"
#include "sw_model/exact_distance.h"
#include "testbench/random.h"
#include "testbench/stimuli.h"

namespace emax {
namespace {

// Vertices of a mesh moved at random, the points that their triangles answer for, and the truth.
struct Edits {
  explicit Edits(std::uint64_t seed) : surface(test::bumpy_sphere(12, 18, 1500, seed)) {
    Random random(seed);
    const ExactMesh mesh(surface.mesh());
    std::vector<std::uint32_t> nearest;
    std::vector<double> distances;
    for (const Point& p : surface.cloud) {
      const ExactMesh::Nearest found = mesh.nearest(p);
      nearest.push_back(found.triangle);
      distances.push_back(found.distance.upper);
    }
    std::ranges::sort(distances);
    epsilon = distances[distances.size() * 9 / 10];
    for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
      BlockQuestion question;
      std::vector<std::uint32_t> around;
      const auto coordinate = [&] { return epsilon * random.uniform(-1, 1); };
      const Point moved = surface.vertices[v] + Point(coordinate(), coordinate(), coordinate());
      for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        std::array<Point, 3> corners = surface.mesh().corners(t);
        bool touches = false;
        for (std::size_t k = 0; k < 3; ++k) {
          if (surface.triangles[t][k] != v) continue;
          corners[k] = moved;
          touches = true;
        }
        if (!touches) continue;
        around.push_back(t);
        question.triangles.push_back(corners);
      }
      for (std::uint32_t p = 0; p < nearest.size(); ++p) {
        if (std::ranges::find(around, nearest[p]) != around.end()) question.points.push_back(p);
      }
      if (!question.points.empty()) questions.push_back(std::move(question));
    }
  }

  DistanceBounds truth(const BlockQuestion& question) const {
    DistanceBounds greatest = {0, 0};
    for (const std::uint32_t p : question.points) {
      DistanceBounds least = {INFINITY, INFINITY};
      for (const std::array<Point, 3>& corners : question.triangles) {
        const DistanceBounds d = point_triangle_distance(surface.cloud[p], corners);
        least = {std::min(least.lower, d.lower), std::min(least.upper, d.upper)};
      }
      greatest = {std::max(greatest.lower, least.lower), std::max(greatest.upper, least.upper)};
    }
    return greatest;
  }

  test::Stimulus surface;
  double epsilon;
  std::vector<BlockQuestion> questions;
};

TEST(BlockQuestions, AgreeWithTheOracleOnEveryEvaluator) {
  const Edits edits(81);
  const BlockQuestions local(edits.surface.cloud, edits.epsilon);
  SimdEvaluator cpu;
  const std::vector<BlockVerdict> verdicts = local.ask(edits.questions, cpu);
  ASSERT_EQ(verdicts.size(), edits.questions.size());
  std::size_t within = 0, beyond = 0;
  for (std::size_t q = 0; q < verdicts.size(); ++q) {
    const DistanceBounds truth = edits.truth(edits.questions[q]);
    if (verdicts[q] == BlockVerdict::kWithin) {
      ++within;
      EXPECT_LE(truth.upper, edits.epsilon) << q;
    } else if (verdicts[q] == BlockVerdict::kBeyond) {
      ++beyond;
      EXPECT_GT(truth.lower, edits.epsilon) << q;
    }
  }
  EXPECT_GT(within, 20u);
  EXPECT_GT(beyond, 20u);
  EXPECT_GT(within + beyond, verdicts.size() - 3);
  for (const char* device : {"sim", "rtl:pes=2"}) {
    const std::unique_ptr<Evaluator> evaluator = make_evaluator(DeviceAddress::parse(device));
    EXPECT_EQ(local.ask(edits.questions, *evaluator), verdicts) << device;
    EXPECT_GT(evaluator->counters().pairs, 1000u);
    // And again, after the records have changed.
    const auto half = std::span(edits.questions).subspan(edits.questions.size() / 2);
    const auto again = local.ask(half, *evaluator);
    EXPECT_TRUE(std::ranges::equal(again, std::span(verdicts).subspan(verdicts.size() / 2)));
  }
}

TEST(BlockQuestions, LeaveOpenWhatTheKernelCannotTell) {
  const Edits edits(82);
  SimdEvaluator cpu;
  for (const BlockQuestion& question : std::span(edits.questions).first(20)) {
    const double exact = edits.truth(question).upper;
    const auto verdict = [&](double epsilon) {
      return BlockQuestions(edits.surface.cloud, epsilon).ask(std::span(&question, 1), cpu)[0];
    };
    EXPECT_EQ(verdict(exact), BlockVerdict::kOpen);
    EXPECT_EQ(verdict(exact * (1 + 1e-3)), BlockVerdict::kWithin);
    EXPECT_EQ(verdict(exact * (1 - 1e-3)), BlockVerdict::kBeyond);
  }
}

TEST(BlockQuestions, AnswerWithoutPointsAndRefuseWithoutTriangles) {
  const Edits edits(83);
  const BlockQuestions local(edits.surface.cloud, edits.epsilon);
  SimdEvaluator cpu;
  EXPECT_TRUE(local.ask({}, cpu).empty());
  BlockQuestion question = edits.questions[0];
  question.points.clear();
  EXPECT_EQ(local.ask(std::span(&question, 1), cpu)[0], BlockVerdict::kWithin);
  question.triangles.clear();
  EXPECT_THROW(local.ask(std::span(&question, 1), cpu), std::invalid_argument);
}

}  // namespace
}  // namespace emax
