#include "host/emax_search/block_questions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "sw_model/error_bound.h"
#include "sw_model/float_bits.h"
#include "sw_model/triangle_frame.h"

namespace emax {
namespace {

constexpr std::size_t kUnderWay = 4;  // blocks

// The greatest |vertex| and twice the longest edge.
double reach_of(std::span<const std::array<Point, 3>> triangles,
                const Normalization& normalization) {
  double vertex = 0, edge = 0;
  for (const std::array<Point, 3>& corners : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      vertex = std::max(vertex, normalization.apply(corners[k]).norm());
      edge = std::max(edge, normalization.length((corners[(k + 1) % 3] - corners[k]).norm()));
    }
  }
  return vertex + 2 * edge;
}

}  // namespace

BlockQuestions::BlockQuestions(std::span<const Point> cloud, double epsilon)
    : normalization_(normalization_of(cloud)),
      points_(normalized_points(cloud, normalization_)),
      epsilon_(normalization_.length(epsilon)) {}

std::vector<BlockVerdict> BlockQuestions::ask(std::span<const BlockQuestion> questions,
                                              Evaluator& evaluator) const {
  std::vector<Point> corners;
  std::vector<Triangle> triangles;
  for (const BlockQuestion& question : questions) {
    if (question.triangles.empty()) throw std::invalid_argument("a question without triangles");
    for (const std::array<Point, 3>& triangle : question.triangles) {
      const auto first = static_cast<std::uint32_t>(corners.size());
      corners.insert(corners.end(), triangle.begin(), triangle.end());
      triangles.push_back({first, first + 1, first + 2});
    }
  }
  const std::vector<TriangleRecord<float>> records =
      make_records({corners, triangles}, normalization_);
  evaluator.begin(points_, records);

  std::vector<float> farthest(questions.size(), 0);  // squared
  std::vector<std::size_t> asked;                    // the question of each block
  std::size_t answered = 0;
  const auto collect = [&] {
    float& worst = farthest[asked[answered++]];
    worst = std::max(worst, bits_float(evaluator.collect().worst.squared_bits));
  };
  std::uint32_t first_record = 0;
  for (std::size_t q = 0; q < questions.size(); ++q) {
    const std::vector<std::uint32_t>& points = questions[q].points;
    Block block;
    for (std::size_t t = 0; t < questions[q].triangles.size(); ++t) {
      block.candidates.push_back(first_record++);
    }
    for (std::size_t first = 0; first < points.size(); first += evaluator.block_points()) {
      const std::size_t last = std::min(first + evaluator.block_points(), points.size());
      block.points.assign(points.begin() + static_cast<std::ptrdiff_t>(first),
                          points.begin() + static_cast<std::ptrdiff_t>(last));
      if (asked.size() - answered == kUnderWay) collect();
      evaluator.submit(block, false);
      asked.push_back(q);
    }
  }
  while (answered < asked.size()) collect();

  std::vector<BlockVerdict> verdicts;
  for (std::size_t q = 0; q < questions.size(); ++q) {
    const double reach = reach_of(questions[q].triangles, normalization_);
    const double distance = std::sqrt(static_cast<double>(farthest[q]));
    const auto feasible = largest_feasible_bits(epsilon_, epsilon_ + reach);
    // Twice the margin: once for the kernel, once for the point, which was rounded before.
    const double margin = 2 * kernel_distance_margin(distance, reach, 0);
    verdicts.push_back(feasible && float_bits(farthest[q]) <= *feasible ? BlockVerdict::kWithin
                       : distance - margin > epsilon_                   ? BlockVerdict::kBeyond
                                                                        : BlockVerdict::kOpen);
  }
  return verdicts;
}

}  // namespace emax
