#include "sw_model/model/triangle_frame.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using Corners = std::array<Point, 3>;

void expect_rotation(const TriangleFrame& frame) {
  Eigen::Matrix3d rows;
  rows << eigen(frame.record.normal).transpose(), eigen(frame.record.in_plane).transpose(),
      eigen(frame.record.along).transpose();
  EXPECT_LT((rows * rows.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(rows.determinant(), 1, 1e-15);
}

TEST(TriangleFrame, PutsV1OnTheOriginV2OnZAndV3InThePlane) {
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Corners corners = {random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
    const TriangleFrame frame = make_frame(corners);
    ASSERT_FALSE(frame.segment);
    expect_rotation(frame);
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).norm());
      const Point p = corners[k] - eigen(frame.record.v1);
      const Point local(eigen(frame.record.normal).dot(p), eigen(frame.record.in_plane).dot(p),
                        eigen(frame.record.along).dot(p));
      const bool is_a_vertex = (local - Point(0, 0, 0)).norm() < 1e-14 ||
                               (local - Point(0, 0, frame.record.length12)).norm() < 1e-14 ||
                               (local - Point(0, frame.v3.y, frame.v3.z)).norm() < 1e-14;
      EXPECT_TRUE(is_a_vertex) << local.transpose();
    }
    EXPECT_DOUBLE_EQ(frame.record.length12, longest);
    EXPECT_GT(frame.v3.y, 0);
  }
}

TEST(TriangleFrame, GivesTiesToTheFirstEdgeInFileOrder) {
  const Point a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
  EXPECT_EQ(eigen(make_frame({a, d, b}).record.v1), a);  // only a-d is longest
  EXPECT_EQ(eigen(make_frame({b, a, d}).record.v1), a);  // second edge
  EXPECT_EQ(eigen(make_frame({d, b, a}).record.v1), a);  // third edge, a to d
  EXPECT_EQ(eigen(make_frame({Point(0, 3, 0), Point(0, 0, 4), Point(0, 0, -4)}).record.v1),
            Point(0, 0, 4));
  // Isosceles: V1V2 and V3V1 equal and longest; then V2V3 and V3V1.
  EXPECT_EQ(eigen(make_frame({Point(0, 0, 5), Point(1, 0, 0), Point(-1, 0, 0)}).record.v1),
            Point(0, 0, 5));
  EXPECT_EQ(eigen(make_frame({Point(1, 0, 0), Point(-1, 0, 0), Point(0, 0, 5)}).record.v1),
            Point(-1, 0, 0));
  (void)c;
}

TEST(TriangleFrame, TakesLowTrianglesAsSegments) {
  const Point a(0, 0, 0), b(2, 0, 0);
  EXPECT_TRUE(make_frame({a, b, Point(1, 1.9e-6, 0)}).segment);
  EXPECT_FALSE(make_frame({a, b, Point(1, 2.1e-6, 0)}).segment);
  EXPECT_TRUE(make_frame({a, b, Point(0.5, 0, 0)}).segment);
  EXPECT_TRUE(make_frame({a, b, a}).segment);
  const TriangleFrame point = make_frame({b, b, b});
  EXPECT_TRUE(point.segment);
  EXPECT_EQ(point.record.length12, 0);
  expect_rotation(point);
  expect_rotation(make_frame({a, b, a}));
}

TEST(TriangleFrame, KeepsTinyAndHugeTriangles) {
  for (const double size : {1e-100, 1e-30, 1e9}) {
    const TriangleFrame frame =
        make_frame({Point(0, 0, 0), Point(size, 0, 0), Point(0, size / 2, 0)});
    expect_rotation(frame);
    EXPECT_FALSE(frame.segment) << size;
  }
}

TEST(TriangleFrame, RefusesWhatIsNotFiniteOrTooFar) {
  Normalization unit;
  const std::vector<Triangle> one = {{0, 1, 2}};
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 0x1.1p32}) {
    const std::vector<Point> vertices = {Point(0, 0, 0), Point(1, 0, 0), Point(0, bad, 0)};
    EXPECT_THROW(make_records({vertices, one}, unit), Error) << bad;
  }
  EXPECT_THROW(
      make_record(make_frame({Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)}), kMaxTriangles),
      std::invalid_argument);
}

TEST(TriangleFrame, MustNotRunFlushed) {
  const ScopedFlushMode flush;
  EXPECT_THROW(make_records({}, Normalization{}), std::logic_error);
}

}  // namespace
}  // namespace emax
