#include "host/report/report_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

// Reads the arrays one after the other, as the page does.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  template <class Value>
  std::vector<Value> take(std::size_t count) {
    std::vector<Value> values(count);
    EXPECT_LE(at_ + count * sizeof(Value), bytes_.size());
    if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
    return values;
  }
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

TEST(ReportGeometry, IsReadBackWithinItsSteps) {
  const Stimulus s = bumpy_sphere(8, 10, 3000, 9);
  const Deviations d = deviations_of(s.cloud, s.mesh(), {}, 1);
  const std::vector<std::uint32_t> shown = points_shown(s.cloud, {}, {});
  const ReportGeometry g = report_geometry(s.cloud, shown, s.mesh(), d, 1e-3);
  ASSERT_EQ(g.points, s.cloud.size());
  ASSERT_EQ(g.triangles, s.triangles.size());
  Reader reader(g.bytes);
  std::array<std::vector<std::uint16_t>, 3> at;
  for (auto& axis : at) axis = reader.take<std::uint16_t>(g.points);
  const auto deviations = reader.take<std::int16_t>(g.points);
  for (std::size_t k = 0; k < g.points; ++k) {
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double x = g.origin[a] + g.step[a] * at[static_cast<std::size_t>(a)][k];
      EXPECT_NEAR(x, s.cloud[shown[k]][a], 0.51 * g.step[a]);
    }
    EXPECT_NEAR(
        g.deviation_step * deviations[k],
        std::clamp(d.of_points[shown[k]], -32767 * g.deviation_step, 32767 * g.deviation_step),
        0.51 * g.deviation_step);
  }
  std::array<std::vector<float>, 3> vertices;
  for (auto& axis : vertices) axis = reader.take<float>(g.vertices);
  const auto triangles = reader.take<std::uint32_t>(3 * g.triangles);
  const auto of_triangles = reader.take<float>(g.triangles);
  EXPECT_TRUE(reader.is_at_end());
  for (std::size_t t = 0; t < g.triangles; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = triangles[3 * t + i];
      ASSERT_LT(v, g.vertices);
      const Point there(vertices[0][v], vertices[1][v], vertices[2][v]);
      EXPECT_LT((g.origin + there - s.mesh().corners(t)[i]).norm(),
                1e-3 / 64 * 1.8);  // half a step on each axis, and more
    }
    if (std::isnan(d.of_triangles[t])) {
      EXPECT_TRUE(std::isnan(of_triangles[t]));
    } else {
      EXPECT_NEAR(of_triangles[t], d.of_triangles[t], 2.5e-4 * std::abs(d.of_triangles[t]));
    }
  }
}

TEST(ReportGeometry, FarDeviationsAreClipped) {
  const Stimulus s = bumpy_sphere(8, 10, 500, 10);
  std::vector<Point> cloud = s.cloud;
  cloud[7] *= 1000;
  const Deviations d = deviations_of(cloud, s.mesh(), {}, 1);
  const ReportGeometry g = report_geometry(cloud, std::vector<std::uint32_t>{7, 8}, s.mesh(), d, 1);
  Reader reader(g.bytes);
  reader.take<std::uint16_t>(3 * g.points);
  const auto deviations = reader.take<std::int16_t>(2);
  EXPECT_EQ(deviations[0], 32767);
  EXPECT_LT(std::abs(deviations[1]), 32767);
}

TEST(PointsShown, AreThinnedEvenlyAndKeepTheWorst) {
  const Stimulus s = bumpy_sphere(4, 4, 5000, 11);
  const std::vector<std::uint32_t> excluded = {1, 2, 3}, always = {4999, 17, 2500};
  EXPECT_EQ(points_shown(s.cloud, excluded, always).size(), 4997u);
  const auto thinned = points_shown(s.cloud, excluded, always, 500);
  EXPECT_LE(thinned.size(), 500u);
  EXPECT_GE(thinned.size(), 497u);
  EXPECT_EQ(thinned, points_shown(s.cloud, excluded, always, 500));
  const std::set<std::uint32_t> set(thinned.begin(), thinned.end());
  EXPECT_EQ(set.size(), thinned.size());
  for (const std::uint32_t i : always) EXPECT_TRUE(set.contains(i)) << i;
  for (const std::uint32_t i : excluded) EXPECT_FALSE(set.contains(i)) << i;
  // Along the curve of all points no gap is more than twice the mean.
  const auto all = points_shown(s.cloud, excluded, {});
  std::size_t gap = 0;
  for (const std::uint32_t i : all) {
    gap = set.contains(i) ? 0 : gap + 1;
    EXPECT_LE(gap, 20u);
  }
}

}  // namespace
}  // namespace emax::test
