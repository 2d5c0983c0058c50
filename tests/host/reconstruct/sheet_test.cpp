#include "host/reconstruct/sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "host/geometry/mesh_topology.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/host/features/clouds.h"

namespace emax::test {
namespace {

const Cylinder kPipe = {.centre = {1, 2, 3}, .axis = Point(1, 2, 2) / 3, .radius = 0.5};

Region region_of(const Shape& shape, std::size_t points, double area) {
  Region region{shape};
  region.points.resize(points);
  std::iota(region.points.begin(), region.points.end(), 0u);
  region.area = area;
  return region;
}

TEST(Sheet, LaysOutFlatAndBack) {
  Random random(1);
  const Plane plane = {.normal = Point(2, -1, 2) / 3, .offset = 5};
  std::vector<Point> cloud;
  scan_cylinder(kPipe, 4, 6, 500, 0.01, random, cloud);
  for (const Shape& shape : {Shape(plane), Shape(kPipe)}) {
    const Region region = region_of(shape, cloud.size(), 1);
    const Sheet sheet(cloud, region, 3);
    for (const Point& p : cloud) {
      const Point onto = sheet.onto(p);
      EXPECT_LT(distance(shape, onto), 1e-12);
      EXPECT_NEAR((p - onto).norm(), distance(shape, p), 1e-12);
      EXPECT_LT((sheet.flatten(onto) - sheet.flatten(p)).norm(), 1e-12);
      // Triangles that run anticlockwise are seen from where the normal points to.
      const Eigen::Vector2d flat = sheet.flatten(p);
      const Point u = sheet.raise(flat + Eigen::Vector2d(1e-4, 0)) - onto;
      const Point v = sheet.raise(flat + Eigen::Vector2d(0, 1e-4)) - onto;
      EXPECT_NEAR(u.norm(), 1e-4, 1e-8);
      EXPECT_GT(u.cross(v).dot(std::visit([&](const auto& s) { return s.normal_at(p); }, shape)),
                0.99e-8);
    }
  }
}

TEST(Sheet, ClosesAroundACylinderOnce) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    std::vector<Point> cloud;
    scan_cylinder(kPipe, 4, 2 * std::numbers::pi, 900, 0, random, cloud);
    const Region region = region_of(kPipe, cloud.size(), 4 * std::numbers::pi);
    const Sheet sheet(cloud, region, 5);
    std::vector<Eigen::Vector2d> places;
    for (const Point& p : cloud) places.push_back(sheet.flatten(p));
    const std::vector<Triangle> triangles = sheet.triangulate(places);
    const MeshTopology topology = topology_of({cloud, triangles});
    EXPECT_EQ(topology.components, 1u);
    EXPECT_EQ(topology.border_loops, 2u);
    EXPECT_EQ(topology.genus, 0u);
  }
}

TEST(Sheet, OfPartOfACylinderStaysOpen) {
  Random random(4);
  std::vector<Point> cloud;
  scan_cylinder(kPipe, 4, 1.2, 600, 0, random, cloud);
  const Region region = region_of(kPipe, cloud.size(), 4 * 1.2);
  const Sheet sheet(cloud, region, 5);
  std::vector<Eigen::Vector2d> places;
  for (const Point& p : cloud) places.push_back(sheet.flatten(p));
  const std::vector<Triangle> triangles = sheet.triangulate(places);
  EXPECT_EQ(topology_of({cloud, triangles}).border_loops, 1u);
}

// A pipe as rows of a scanner far away meet it: across, farther apart than it is wide, every other
// one shorter.
struct RowsOnPipe {
  static constexpr double kLong = 0.7, kShort = 0.5, kApart = 1;
  static constexpr int kRows = 11;

  RowsOnPipe() {
    const Point u = kPipe.axis.unitOrthogonal(), v = kPipe.axis.cross(u);
    for (int row = 0; row < kRows; ++row) {
      const double half = row % 2 == 0 ? kLong : kShort;
      for (double s = -half; s < half + 1e-9; s += 0.1) {
        const double angle = s / kPipe.radius;
        cloud.push_back(kPipe.centre + kApart * row * kPipe.axis +
                        kPipe.radius * (std::cos(angle) * u + std::sin(angle) * v));
      }
    }
  }

  // Of the flat triangles over that of the strip that the longer rows bound.
  double spanned() {
    const double strip = 2 * kLong * kApart * (kRows - 1);
    const Region region = region_of(kPipe, cloud.size(), strip);
    const Sheet sheet(cloud, region, 4);
    std::vector<Eigen::Vector2d> places;
    for (const Point& p : cloud) places.push_back(sheet.flatten(p));
    triangles = sheet.triangulate(places);
    double area = 0;
    for (const auto& [a, b, c] : triangles) {
      const Eigen::Vector2d ab = places[b] - places[a], ac = places[c] - places[a];
      area += (ab.x() * ac.y() - ab.y() * ac.x()) / 2;
    }
    return area / strip;
  }

  std::vector<Point> cloud;
  std::vector<Triangle> triangles;
};

TEST(Sheet, OfACylinderHasStraightBorders) {
  RowsOnPipe rows;
  const double spanned = rows.spanned();
  EXPECT_LE(spanned, 1 + 1e-9);
  EXPECT_GT(spanned, 0.98);
  EXPECT_EQ(topology_of({rows.cloud, rows.triangles}).border_loops, 1u);
}

TEST(SheetFault, RaggedBordersOfACylinderAreNoticed) {
  const DeliberateFault fault(Fault::kSpansAlikeAlongAxes);
  EXPECT_LT(RowsOnPipe().spanned(), 0.98);
}

}  // namespace
}  // namespace emax::test
