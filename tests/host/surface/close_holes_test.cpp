#include "host/surface/close_holes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "host/geometry/exact_predicates.h"
#include "host/geometry/mesh_validity.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Patch = std::vector<std::array<std::size_t, 3>>;

// Every triangulation of the polygon from corner i to j.
std::vector<Patch> all_patches(std::size_t i, std::size_t j) {
  if (j - i < 2) return {{}};
  std::vector<Patch> all;
  for (std::size_t k = i + 1; k < j; ++k) {
    for (const Patch& low : all_patches(i, k)) {
      for (const Patch& high : all_patches(k, j)) {
        Patch patch = low;
        patch.insert(patch.end(), high.begin(), high.end());
        patch.push_back({i, k, j});
        all.push_back(patch);
      }
    }
  }
  return all;
}

PatchQuality quality_of(const Patch& patch, std::span<const Point> hole,
                        std::span<const Point> behind) {
  const std::size_t n = hole.size();
  std::map<std::pair<std::size_t, std::size_t>, Point> normals;  // by directed edge
  PatchQuality quality;
  for (const auto& t : patch) {
    const Point normal = (hole[t[1]] - hole[t[0]]).cross(hole[t[2]] - hole[t[0]]);
    quality.area += 0.5 * normal.norm();
    for (std::size_t e = 0; e < 3; ++e) normals[{t[e], t[(e + 1) % 3]}] = normal;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Point &from = hole[i], &to = hole[(i + 1) % n];
    normals[{(i + 1) % n, i}] = (from - to).cross(behind[i] - to);
  }
  for (const auto& [edge, normal] : normals) {
    const Point& other = normals.at({edge.second, edge.first});
    quality.fold = std::min(quality.fold, normal.dot(other) / (normal.norm() * other.norm()));
  }
  return quality;
}

TEST(BestPatch, IsTheBestOfAllTriangulations) {
  Random random(91);
  const auto point = [&] {
    return Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (int round = 0; round < 300; ++round) {
    const std::size_t corners = 3 + static_cast<std::size_t>(round) % 5;
    std::vector<Point> hole, behind;
    std::vector<bool> joins(corners * corners);
    for (std::size_t i = 0; i < corners; ++i) {
      hole.push_back(point());
      behind.push_back(point());
    }
    for (std::size_t i = 0; i < joins.size(); ++i) joins[i] = random.uniform(0, 1) < 0.8;
    const auto may_join = [&](std::size_t i, std::size_t j) -> bool {
      return joins[i * corners + j];
    };
    std::optional<PatchQuality> best;
    for (const Patch& patch : all_patches(0, corners - 1)) {
      const bool allowed = std::ranges::all_of(patch, [&](const auto& t) {
        const bool outer = t[0] == 0 && t[2] == corners - 1;
        return (outer || t[2] - t[0] < 2 || may_join(t[0], t[2]));
      });
      if (!allowed) continue;
      const PatchQuality quality = quality_of(patch, hole, behind);
      if (!best || quality.better_than(*best)) best = quality;
    }
    const std::optional<HolePatch> found = best_patch(hole, behind, may_join);
    ASSERT_EQ(found.has_value(), best.has_value()) << round;
    if (!best) continue;
    EXPECT_NEAR(found->quality.fold, best->fold, 1e-12) << round;
    const PatchQuality told = quality_of(found->triangles, hole, behind);
    EXPECT_NEAR(told.fold, found->quality.fold, 1e-12) << round;
    EXPECT_NEAR(told.area, found->quality.area, 1e-12) << round;
    EXPECT_EQ(found->triangles.size(), corners - 2);
  }
}

TEST(BestPatch, ClosesAPolygonOfManyCorners) {
  constexpr std::size_t kCorners = 400;
  std::vector<Point> hole, behind;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / kCorners;
    hole.emplace_back(std::cos(turn), 2 * std::sin(turn), 0);
    const double half = turn + std::numbers::pi / kCorners;
    behind.emplace_back(1.1 * std::cos(half), 2.2 * std::sin(half), 0);
  }
  const auto any = [](std::size_t, std::size_t) { return true; };
  const std::optional<HolePatch> found = best_patch(hole, behind, any);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->triangles.size(), kCorners - 2);
  EXPECT_NEAR(found->quality.fold, 1, 1e-12);
  const double area = kCorners * std::sin(2 * std::numbers::pi / kCorners);  // of the ellipse
  EXPECT_NEAR(found->quality.area, area, 1e-9);
  const PatchQuality told = quality_of(found->triangles, hole, behind);
  EXPECT_NEAR(told.area, area, 1e-9);
  EXPECT_NEAR(told.fold, 1, 1e-12);
}

// A crack between two sheets whose rims waver: its patch runs across it from end to end.
TEST(BestPatch, ClosesALongCrack) {
  constexpr int kSideCorners = 60;
  std::vector<Point> hole, behind;
  const auto rim = [](double x, double side) {
    return Point(x, side * (0.3 + 0.2 * std::sin(1.7 * x + side)), 0.2 * std::cos(0.9 * x));
  };
  for (const int side : {-1, 1}) {
    for (int i = 0; i < kSideCorners; ++i) {
      const double x = side < 0 ? i : kSideCorners - 1 - i;
      hole.push_back(rim(x, side));
      behind.push_back(rim(x - 0.5 * side, side) + Point(0, side, 0));
    }
  }
  const auto any = [](std::size_t, std::size_t) { return true; };
  const std::optional<HolePatch> found = best_patch(hole, behind, any);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->triangles.size(), hole.size() - 2);
  EXPECT_GT(found->quality.fold, 0.5);
  const PatchQuality told = quality_of(found->triangles, hole, behind);
  EXPECT_NEAR(told.fold, found->quality.fold, 1e-12);
  EXPECT_NEAR(told.area, found->quality.area, 1e-9);
}

TEST(BestPatch, HasNoTriangleWithoutArea) {
  const std::vector<Point> hole = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  const std::vector<Point> behind = {{0, -1, 0}, {1, -1, 0}, {3, 1, 0}, {-1, 1, 0}};
  const auto any = [](std::size_t, std::size_t) { return true; };
  const std::optional<HolePatch> found = best_patch(hole, behind, any);
  ASSERT_TRUE(found);
  for (const auto& [a, b, c] : found->triangles) {
    EXPECT_FALSE(collinear(hole[a], hole[b], hole[c]));
  }
  EXPECT_FALSE(best_patch(std::span(hole).first(3), std::span(behind).first(3), any));
}

constexpr std::uint32_t kSide = 13;

std::uint32_t at(std::uint32_t x, std::uint32_t y) { return y * kSide + x; }

// A slightly bent sheet of (kSide-1)^2 squares, without the triangles at these vertices.
TriangleMesh sheet_without(std::initializer_list<std::uint32_t> removed) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      mesh.vertices.emplace_back(x, y, 0.02 * (x * x + 0.5 * x * y));
    }
  }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
      mesh.triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::ranges::any_of(
        t, [&](std::uint32_t v) { return std::ranges::find(removed, v) != removed.end(); });
  });
  return mesh;
}

constexpr std::size_t kOuterEdges = 4 * (kSide - 1);
constexpr double kSize = 0.25;  // more than any hole here, less than the sheet

TEST(CloseHoles, ClosesHolesAndLeavesTheRestAlone) {
  const TriangleMesh open = sheet_without({at(4, 4), at(8, 7), at(8, 8)});
  const ClosedHoles closed = close_holes(open, kSize);
  EXPECT_EQ(closed.closed, 2u);
  EXPECT_EQ(closed.dropped, 0u);
  const MeshValidity validity = check_mesh(closed.mesh.view());
  EXPECT_TRUE(validity.valid());
  EXPECT_EQ(validity.boundary_edges, kOuterEdges);
  // A hole of k edges takes k - 2 triangles.
  EXPECT_EQ(closed.mesh.triangles.size(), open.triangles.size() + (6 - 2) + (8 - 2));
}

TEST(CloseHoles, LeavesHolesThatAreTooWide) {
  const TriangleMesh open = sheet_without({at(6, 6)});
  const ClosedHoles closed = close_holes(open, 0.05);
  EXPECT_EQ(closed.closed, 0u);
  EXPECT_EQ(check_mesh(closed.mesh.view()).boundary_edges, kOuterEdges + 6);
}

TEST(CloseHoles, ASheetIsNoHole) {
  const TriangleMesh sheet = sheet_without({});
  const ClosedHoles closed = close_holes(sheet, 10);
  EXPECT_EQ(closed.closed, 0u);
  EXPECT_EQ(closed.mesh.triangles, sheet.triangles);
}

TEST(CloseHoles, DropsARimThatFoldsOverItself) {
  TriangleMesh open = sheet_without({at(6, 6)});
  open.vertices[at(5, 6)] = open.vertices[at(7, 6)] + Point(0.4, 0.1, 0.6);  // across the hole
  ASSERT_TRUE(check_mesh(open.view()).valid());
  const ClosedHoles closed = close_holes(open, kSize);
  EXPECT_EQ(closed.closed, 1u);
  EXPECT_GT(closed.dropped, 0u);
  const MeshValidity validity = check_mesh(closed.mesh.view());
  EXPECT_TRUE(validity.valid());
  EXPECT_EQ(validity.boundary_edges, kOuterEdges);
}

TEST(CloseHoles, LeavesAHoleThatSomethingRunsThrough) {
  TriangleMesh open = sheet_without({at(6, 6)});
  const auto first = static_cast<std::uint32_t>(open.vertices.size());
  const Point middle = open.vertices[at(6, 6)];
  for (const Point& p : {Point(0.1, 0, -9), Point(-0.1, 0.1, -9), Point(-0.1, -0.1, -9)}) {
    open.vertices.push_back(middle + p);
  }
  open.vertices.push_back(middle + Point(0, 0, 9));
  for (std::uint32_t i = 0; i < 3; ++i) {
    open.triangles.push_back({first + i, first + (i + 1) % 3, first + 3});
  }
  open.triangles.push_back({first, first + 2, first + 1});
  ASSERT_TRUE(check_mesh(open.view()).valid());
  const ClosedHoles closed = close_holes(open, kSize);
  EXPECT_EQ(closed.closed, 0u);
  EXPECT_EQ(check_mesh(closed.mesh.view()).boundary_edges, kOuterEdges + 6);
}

// The holes of a sheet, but not its border, whose patch would fold back.
TEST(CloseSurface, NamesWhatCannotBeClosed) {
  const ClosedSurface closed = close_surface(sheet_without({at(4, 4), at(8, 8)}));
  EXPECT_EQ(closed.closed, 2u);
  ASSERT_EQ(closed.open.size(), 1u);
  EXPECT_EQ(closed.open[0].edges, kOuterEdges);
  EXPECT_NEAR(closed.open[0].middle.x(), 6, 1e-9);
  EXPECT_NEAR(closed.open[0].middle.y(), 6, 1e-9);
  EXPECT_GT(closed.open[0].radius, 6 * std::sqrt(2.0));
  EXPECT_LT(closed.open[0].radius, 12);
}

// A bowl's rim, longer than that of any hole that is a crack.
TEST(CloseSurface, ClosesALongRim) {
  constexpr std::uint32_t kAround = kMostHoleEdges + 20, kRings = 4;
  TriangleMesh bowl;
  for (std::uint32_t r = 0; r < kRings; ++r) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      bowl.vertices.emplace_back((20 + r) * std::cos(angle), (20 + r) * std::sin(angle), r * r);
    }
  }
  const auto middle = static_cast<std::uint32_t>(bowl.vertices.size());
  bowl.vertices.emplace_back(0, 0, -1);
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t j = (i + 1) % kAround;
    bowl.triangles.push_back({middle, i, j});
    for (std::uint32_t r = 0; r + 1 < kRings; ++r) {
      const std::uint32_t a = r * kAround + i, b = r * kAround + j;
      bowl.triangles.push_back({a, a + kAround, b});
      bowl.triangles.push_back({b, a + kAround, b + kAround});
    }
  }
  ASSERT_TRUE(check_mesh(bowl.view()).valid());
  EXPECT_EQ(close_holes(bowl, 1).closed, 0u);
  const ClosedSurface closed = close_surface(bowl);
  EXPECT_EQ(closed.closed, 1u);
  EXPECT_TRUE(closed.open.empty());
  const MeshValidity validity = check_mesh(closed.mesh.view());
  EXPECT_TRUE(validity.valid());
  EXPECT_EQ(validity.boundary_edges, 0u);
}

}  // namespace
}  // namespace emax::test
