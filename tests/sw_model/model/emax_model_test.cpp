#include "sw_model/model/emax_model.h"

#include <gtest/gtest.h>

#include "hls/kernel/emax_kernel.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/certify/exact_distance.h"
#include "sw_model/model/error_bound.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/commands.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// Pairs of the stimulus whose kernel distance is farther from the oracle's than the proven bound.
int pairs_out_of_bound(const test::Stimulus& s, bool segment_rule) {
  const Normalization normalization = normalization_of(s.cloud);
  const auto points = normalized_points(s.cloud, normalization);
  const auto records = make_records(s.mesh(), normalization);
  int out = 0;
  for (std::size_t j = 0; j < records.size(); ++j) {
    TriangleRecord<float> record = records[j];
    if (!segment_rule) record.tag &= ~kSegmentFlag;
    std::array<Point, 3> corners = s.mesh().corners(j);
    for (Point& corner : corners) corner = normalization.apply(corner);
    for (std::size_t i = 0; i < points.size(); i += 3) {
      const Point p(points[i].x, points[i].y, points[i].z);
      const DistanceBounds exact = point_triangle_distance(p, corners);
      const Point v1(record.v1.x, record.v1.y, record.v1.z);
      const double bound =
          kKappa * ((p - v1).norm() + static_cast<double>(record.length12) + v1.norm()) +
          kDistanceFloor;
      const double d = distance_of(pair_squared_bits(points[i], record));
      out += d > exact.upper + bound || d < exact.lower - bound;
    }
  }
  return out;
}

TEST(EmaxModel, StaysWithinTheProvenBoundOnEveryStimulus) {
  for (const test::Stimulus& s : test::all_stimuli(80)) {
    EXPECT_EQ(pairs_out_of_bound(s, true), 0) << s.name << ", seed 80";
  }
}

// Degenerate triangles taken for ordinary ones: a zero-length edge seems to hold every point.
TEST(EmaxModel, MissingDegenerateRuleIsCaught) {
  EXPECT_GT(pairs_out_of_bound(test::named_stimulus("degenerate", 80), false), 0);
}

std::vector<Word> answer_of(EmaxKernel<float>& kernel, const std::vector<Word>& words) {
  Stream<Word> commands, answers;
  for (const Word word : words) commands.write(word);
  while (!commands.empty()) kernel.serve(commands, answers);
  std::vector<Word> answer;
  while (!answers.empty()) answer.push_back(answers.read());
  return {answer.begin() + 1, answer.end() - kAnswerWorst};
}

// Distances whose squares are subnormal: an engine that keeps them gives other bits.
TEST(EmaxModel, MissingFlushIsCaught) {
  test::Random random(81);
  std::vector<Vector3<float>> points;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f p = (random.point(-1, 1) * 0x1p-63).cast<float>();
    points.push_back({p.x(), p.y(), p.z()});
  }
  const std::vector<TriangleRecord<float>> records = {
      make_record(make_frame({Point(0, 0, 0), Point(0x1p-62, 0, 0), Point(0, 0x1p-62, 0)}), 0)};
  std::vector<Word> words;
  append_load_points(words, points);
  append_records(words, records);
  append_reduce(words, true);

  EmaxKernel<float> kernel;
  const std::vector<Word> expected = nearest_squared_bits(points, records);
  EXPECT_NE(answer_of(kernel, words), expected);
  const ScopedFlushMode flush;
  EXPECT_EQ(answer_of(kernel, words), expected);
}

TEST(EmaxModel, RefusesNothing) {
  const std::vector<Vector3<float>> points = {{0, 0, 0}};
  EXPECT_THROW(emax_model(points, {}), std::invalid_argument);
  EXPECT_THROW(worst_of({}), std::invalid_argument);
}

}  // namespace
}  // namespace emax
