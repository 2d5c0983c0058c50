#include "host/measure/point_distances.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sw_model/certify/surface_distance.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// The model's bits, and within the proven margin of the true distances.
void expect_exact(std::span<const Point> points, MeshView mesh) {
  const PreparedCloud cloud(points);
  const auto found = point_distances(cloud, mesh);
  const MeshExtent extent(mesh, cloud.normalization());
  const auto bits = nearest_squared_bits(cloud.points(), make_records(mesh, cloud.normalization()));
  ASSERT_EQ(found.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(found[i], distance_of(bits[i]) / cloud.normalization().scale) << "point " << i;
    long double exact = INFINITY;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      exact = std::min(exact, test::long_double_distance(points[i], mesh.corners(t)));
    }
    const double distance = std::max(found[i], static_cast<double>(exact));
    EXPECT_NEAR(found[i], static_cast<double>(exact),
                point_distance_margin(cloud.normalization(), extent, distance))
        << "point " << i;
  }
}

TEST(PointDistances, EqualTheModelForAllStimuli) {
  for (const test::Stimulus& s : test::all_stimuli(401)) {
    SCOPED_TRACE(s.name + ", seed 401");
    expect_exact(s.cloud, s.mesh());
  }
}

// As the other direction asks for them: vertices against a surface and against a cloud.
TEST(PointDistances, OfVerticesToASurfaceAndToACloud) {
  const test::Stimulus coarse = test::bumpy_sphere(8, 12, 200, 402);
  const test::Stimulus fine = test::bumpy_sphere(16, 24, 0, 402);
  expect_exact(coarse.vertices, fine.mesh());
  const auto points = triangles_of_points(coarse.cloud.size());
  expect_exact(coarse.vertices, {coarse.cloud, points});
}

}  // namespace
}  // namespace emax
