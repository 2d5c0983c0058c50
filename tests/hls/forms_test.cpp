#include <gtest/gtest.h>

#include <cmath>

#include "hls/kernel/forms/barycentric.h"
#include "hls/kernel/forms/guarded_edge.h"
#include "hls/kernel/forms/three_edge.h"
#include "hls/kernel/point_triangle.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// A scalar that counts what it does; its comparisons have a type of their own with no truth value,
// so the forms below would not compile if any of them branched on data.
struct Counts {
  int additions = 0, multiplications = 0;
};
thread_local Counts counts;

struct Condition {
  int unused = 0;
};
struct CountingScalar {
  CountingScalar() = default;
  explicit CountingScalar(float) {}
};
CountingScalar operator+(CountingScalar a, CountingScalar) { return ++counts.additions, a; }
CountingScalar operator-(CountingScalar a, CountingScalar) { return ++counts.additions, a; }
CountingScalar operator*(CountingScalar a, CountingScalar) { return ++counts.multiplications, a; }
Condition operator<(CountingScalar, CountingScalar) { return {}; }
CountingScalar select(Condition, CountingScalar a, CountingScalar) { return a; }
CountingScalar magnitude(CountingScalar a) { return a; }
Condition both(Condition a, Condition) { return a; }
Condition either(Condition a, Condition) { return a; }
Condition negated(Condition a) { return a; }

template <class Record, class Form>
Counts count_operations(Form form) {
  counts = {};
  form(Record{}, Condition{}, Vector3<CountingScalar>{});
  return counts;
}

TEST(Forms, CostTheOperationsTheirHeadersState) {
  const Counts visible = count_operations<TriangleRecord<CountingScalar>>(
      [](const auto& t, auto flag, const auto& p) { squared_distance(t, flag, p); });
  EXPECT_EQ(visible.multiplications, 20);
  EXPECT_EQ(visible.additions, 18);
  const Counts guarded = count_operations<TriangleRecord<CountingScalar>>(
      [](const auto& t, auto flag, const auto& p) { squared_distance_guarded(t, flag, p); });
  EXPECT_EQ(guarded.multiplications, 20);
  EXPECT_EQ(guarded.additions, 18);
  const Counts three = count_operations<TriangleRecord<CountingScalar>>(
      [](const auto& t, auto flag, const auto& p) { squared_distance_three_edge(t, flag, p); });
  EXPECT_EQ(three.multiplications, 24);
  EXPECT_EQ(three.additions, 20);
  const Counts literal = count_operations<BarycentricRecord<CountingScalar>>(
      [](const auto& t, auto flag, const auto& p) { squared_distance_barycentric(t, flag, p); });
  EXPECT_GT(literal.multiplications, three.multiplications);
}

TEST(Forms, AgreeOnEveryStimulus) {
  for (const test::Stimulus& s : test::all_stimuli(11)) {
    SCOPED_TRACE(s.name + ", seed 11");
    const Normalization normalization = normalization_of(s.cloud);
    const auto points = normalized_points(s.cloud, normalization);
    const MeshView mesh = s.mesh();
    for (std::uint32_t j = 0; j < mesh.triangles.size(); j += 2) {
      std::array<Point, 3> corners = mesh.corners(j);
      for (Point& corner : corners) corner = normalization.apply(corner);
      const TriangleFrame frame = make_frame(corners);
      const TriangleRecord<float> record = make_record(frame, j);
      const BarycentricRecord<float> literal = make_barycentric_record(frame, j);
      for (std::size_t i = 0; i < points.size(); i += 5) {
        const double reach = eigen(frame.record.v1).norm() + frame.record.length12 + 2;
        const double d = std::sqrt(squared_distance(record, frame.segment, points[i]));
        ASSERT_NEAR(d, std::sqrt(squared_distance_three_edge(record, frame.segment, points[i])),
                    2e-6 * reach)
            << "point " << i << ", triangle " << j;
        ASSERT_NEAR(d, std::sqrt(squared_distance_guarded(record, frame.segment, points[i])),
                    2e-6 * reach)
            << "point " << i << ", triangle " << j;
        ASSERT_NEAR(d, std::sqrt(squared_distance_barycentric(literal, frame.segment, points[i])),
                    1e-4 * reach)
            << "point " << i << ", triangle " << j;
      }
    }
  }
}

TEST(Forms, VisibleEdgeEqualsThreeEdgeOnSlivers) {
  const test::Stimulus s = test::named_stimulus("slivers", 13);
  const Normalization normalization = normalization_of(s.cloud);
  const auto points = normalized_points(s.cloud, normalization);
  for (const TriangleRecord<float>& record : make_records(s.mesh(), normalization)) {
    const bool segment = (record.tag & kSegmentFlag) != 0;
    for (const Vector3<float>& p : points) {
      ASSERT_NEAR(std::sqrt(squared_distance(record, segment, p)),
                  std::sqrt(squared_distance_three_edge(record, segment, p)), 4e-6);
    }
  }
}

}  // namespace
}  // namespace emax
