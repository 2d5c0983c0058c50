#include "tests/benchmarks/features/plane_truth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/benchmarks/features/edge_distance.h"
#include "tests/support/stimuli.h"

namespace emax::benchmarks {
namespace {

void add_quad(TriangleMesh& mesh, const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Point& p : {a, b, c, d}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

// A floor in two parts that do not touch, a wall, and a column of eighteen facets.
TriangleMesh scene() {
  TriangleMesh mesh;
  add_quad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  add_quad(mesh, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0});
  add_quad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
  const auto on_column = [](int i, double z) {
    const double angle = 2 * std::numbers::pi * i / 36;
    return Point(5 + std::cos(angle), std::sin(angle), z);
  };
  for (int i = 0; i < 36; ++i) {
    add_quad(mesh, on_column(i, 0.5), on_column(i + 1, 0.5), on_column(i + 1, 1.5),
             on_column(i, 1.5));
  }
  return mesh;
}

class PlaneTruthTest : public testing::Test {
 protected:
  PlaneTruthTest() {
    Random random(named_seed("plane truth", 1));
    const auto at = [&](double x, double y, double z) { cloud_.emplace_back(x, y, z); };
    for (int i = 0; i < 100; ++i) at(random.uniform(0, 1), random.uniform(0.01, 1), 0.001);
    for (int i = 0; i < 100; ++i) at(random.uniform(2, 3), random.uniform(0, 1), 0);
    for (int i = 0; i < 100; ++i) at(random.uniform(0, 1), 0, random.uniform(0.01, 1));
    for (int i = 0; i < 100; ++i) at(5 + std::cos(i), std::sin(i), 1);
    for (int i = 0; i < 100; ++i) at(0.5, 0.5, 0.5);
    truth_ = truth_of(scene(), cloud_, 0.01);
  }

  static FoundPlane plane(const Point& normal, double offset, std::uint32_t first,
                          std::uint32_t end) {
    FoundPlane found{{normal, offset}, {}};
    for (std::uint32_t i = first; i < end; ++i) found.points.push_back(i);
    return found;
  }

  std::vector<Point> cloud_;
  PlaneTruth truth_;
};

TEST_F(PlaneTruthTest, MergesWhatIsCoplanarAndLeavesTheCurvedOut) {
  std::size_t with_points = 0;
  for (const auto& known : truth_.planes) with_points += !known.points.empty();
  EXPECT_EQ(with_points, 2u);
  EXPECT_EQ(truth_.planes[truth_.plane_of[0]].points.size(), 200u);
  EXPECT_EQ(truth_.planes[truth_.plane_of[250]].points.size(), 100u);
  EXPECT_EQ(truth_.plane_of[350], PlaneTruth::kNone);
  EXPECT_EQ(truth_.plane_of[450], PlaneTruth::kNone);
}

TEST_F(PlaneTruthTest, CountsWhatIsFoundAndWhatIsWrong) {
  const double tilt = std::numbers::pi / 180;
  const std::vector<FoundPlane> reported = {
      plane({0, std::sin(tilt), std::cos(tilt)}, 0, 0, 190),  // the floor, by a degree
      plane({0, 1, 0}, 0, 200, 240),                          // less than half of the wall
      plane({1, 0, 0}, 5, 300, 400)};                         // a plane in the column
  const PlaneScore score = score_of(truth_, cloud_, reported, 50);
  EXPECT_EQ(score.known, 2u);
  EXPECT_EQ(score.found, 1u);
  EXPECT_EQ(score.reported, 3u);
  EXPECT_EQ(score.wrong, 1u);
  EXPECT_NEAR(score.greatest_angle, 1, 1e-9);
  EXPECT_EQ(score_of(truth_, cloud_, reported, 150).known, 1u);
}

// A step of two plates that meet in a right angle, with points every 0.1.
TEST(MeetingPlanes, AreComparedWithTheEdgesOfAMesh) {
  constexpr double kBand = 0.2;
  std::vector<Point> cloud;
  std::vector<FoundPlane> planes = {{{{0, 0, 1}, 0}, {}}, {{{1, 0, 0}, 0}, {}}};
  for (int i = 0; i <= 20; ++i) {
    for (int j = 1; j <= 10; ++j) {
      for (FoundPlane& plane : planes) {
        plane.points.push_back(static_cast<std::uint32_t>(cloud.size()));
        const double out = 0.1 * j;
        cloud.emplace_back(&plane == planes.data() ? Point(out, 0.1 * i, 0)
                                                   : Point(0, 0.1 * i, out));
      }
    }
  }
  const auto step = [](double at) {
    return TriangleMesh{{{1, 0, 0}, {at, 0, at}, {0, 0, 1}, {1, 2, 0}, {at, 2, at}, {0, 2, 1}},
                        {{0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}}};
  };
  const EdgeDistance exact = distance_of_meeting_planes(planes, cloud, step(0), step(0), kBand);
  EXPECT_EQ(exact.samples, 21u);
  EXPECT_NEAR(exact.mean, 0, 1e-12);
  EXPECT_NEAR(exact.within_half, 1, 1e-12);
  const EdgeDistance off = distance_of_meeting_planes(planes, cloud, step(0), step(0.1), kBand);
  EXPECT_NEAR(off.mean, 0.1 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(off.within_half, 0);
  // Where the reference is far from the line there is no edge.
  EXPECT_EQ(distance_of_meeting_planes(planes, cloud, step(0.2), step(0), kBand).samples, 0u);
}

// A plate of 1 x 1 that goes over into an arc of this radius and of length 1, tilted, with
// coordinates rounded to 1e-4; 21 x 41 vertices, those of the plate first.
TriangleMesh plate_and_arc(double radius) {
  constexpr int kAlong = 41, kAcross = 21;
  const Eigen::AngleAxisd tilt(0.3, Point(1, 2, 3).normalized());
  TriangleMesh mesh;
  for (int i = 0; i < kAlong; ++i) {
    const double beyond = std::max(0.0, 0.05 * i - 1), turn = beyond / radius;
    for (int j = 0; j < kAcross; ++j) {
      const Point p(std::min(1.0, 0.05 * i) + radius * std::sin(turn), 0.05 * j,
                    radius * (1 - std::cos(turn)));
      mesh.vertices.push_back((1e4 * (tilt * p)).array().round() / 1e4);
    }
  }
  for (std::uint32_t i = 0; i + 1 < kAlong; ++i) {
    for (std::uint32_t j = 0; j + 1 < kAcross; ++j) {
      const std::uint32_t at = i * kAcross + j;
      mesh.triangles.push_back({at, at + kAcross, at + kAcross + 1});
      mesh.triangles.push_back({at, at + kAcross + 1, at + 1});
    }
  }
  return mesh;
}

TEST(PlaneTruthOfRoundedMeshes, KeepsAPlaneWholeThatGoesOverIntoAnArc) {
  for (const double radius : {0.5, 2.0, 5.0}) {
    SCOPED_TRACE(radius);
    const TriangleMesh mesh = plate_and_arc(radius);
    const PlaneTruth truth = truth_of(mesh, mesh.vertices, 1e-3, 1e-4);
    const std::uint32_t plane = truth.plane_of.front();
    ASSERT_NE(plane, PlaneTruth::kNone);
    const std::size_t points = truth.planes[plane].points.size();
    EXPECT_GE(points, 20u * 21u);
    EXPECT_LE(points, 24u * 21u);
    for (std::size_t i = 25 * 21; i < mesh.vertices.size(); ++i) {
      EXPECT_EQ(truth.plane_of[i], PlaneTruth::kNone) << i;
    }
  }
}

}  // namespace
}  // namespace emax::benchmarks
