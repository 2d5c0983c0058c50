#include "host/surface/outward.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "host/geometry/mesh_validity.h"
#include "tests/host/support/surface_clouds.h"

namespace emax::test {
namespace {

TriangleMesh sphere(double radius, const Point& centre, bool turned = false) {
  const Stimulus bumpy = bumpy_sphere(8, 12, 0, 3);
  TriangleMesh mesh{bumpy.vertices, bumpy.triangles};
  for (Point& p : mesh.vertices) p = centre + radius * p;
  if (turned) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

void append(TriangleMesh& to, const TriangleMesh& more) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Triangle& t : more.triangles) {
    to.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

// The volume of each of the parts that were appended, which have the same number of triangles.
std::vector<double> volumes(const TriangleMesh& mesh, std::size_t parts) {
  std::vector<double> found;
  const std::size_t size = mesh.triangles.size() / parts;
  for (std::size_t i = 0; i < parts; ++i) {
    TriangleMesh part{mesh.vertices, {}};
    const auto begin = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i * size);
    part.triangles.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    found.push_back(signed_volume(part));
  }
  return found;
}

TEST(OrientOutward, TurnsClosedComponentsOutward) {
  for (const bool turned : {false, true}) {
    TriangleMesh mesh = sphere(1, {0, 0, 0}, turned);
    append(mesh, sphere(0.5, {3, 0.1, 0.1}, !turned));
    append(mesh, sphere(0.5, {-3, -0.1, 0.1}, turned));
    orient_outward(mesh);
    for (const double volume : volumes(mesh, 3)) EXPECT_GT(volume, 0);
    EXPECT_EQ(check_mesh(mesh.view()).inconsistent_edges, 0u);
  }
}

TEST(OrientOutward, WallsOfCavitiesFaceInward) {
  for (unsigned turned = 0; turned < 16; ++turned) {
    // A shell in a shell in a shell, and one beside the innermost; from the innermost on, so that
    // the order does not give it away.
    TriangleMesh mesh = sphere(1, {1.2, 0, 0}, (turned & 1) != 0);
    append(mesh, sphere(1, {-1.5, 0.3, 0.2}, (turned & 2) != 0));
    append(mesh, sphere(6, {0, 0, 0}, (turned & 4) != 0));
    append(mesh, sphere(20, {0, 0, 0}, (turned & 8) != 0));
    orient_outward(mesh);
    const std::vector<double> found = volumes(mesh, 4);
    EXPECT_GT(found[0], 0);
    EXPECT_GT(found[1], 0);
    EXPECT_LT(found[2], 0);
    EXPECT_GT(found[3], 0);
  }
}

TEST(OrientOutward, LeavesOpenComponentsOnTheirSide) {
  TriangleMesh mesh = sphere(1, {0, 0, 0}, true);
  mesh.triangles.pop_back();
  const std::vector<Triangle> before = mesh.triangles;
  orient_outward(mesh);
  EXPECT_EQ(mesh.triangles, before);
  // An open shell hides nothing: what is within it is outside of every solid.
  TriangleMesh both = sphere(4, {0, 0, 0}, true);
  both.triangles.pop_back();
  const std::size_t open = both.triangles.size();
  append(both, sphere(1, {0, 0, 0}, true));
  orient_outward(both);
  EXPECT_GT(signed_volume({both.vertices,
                           {both.triangles.begin() + static_cast<std::ptrdiff_t>(open),
                            both.triangles.end()}}),
            0);
}

// The vertex that a ray begins at lies level with vertices and edges of the others, on a grid of
// few coordinates: the twin counts how often each box holds it.
TEST(OrientOutward, BoxesOnAGridAsTheTwinHasThem) {
  const std::vector<Triangle> faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                       {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                       {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  std::array<std::size_t, 2> seen{};
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    // Boxes are kept where no two surfaces meet: each two are apart or one holds the other.
    std::vector<std::array<Point, 2>> boxes;
    for (int attempt = 0; attempt < 400 && boxes.size() < 9; ++attempt) {
      // Anywhere, or within one of them.
      std::array<Point, 2> around = {Point::Constant(-1), Point::Constant(41)};
      if (!boxes.empty() && random.below(4) != 0) {
        around = boxes[random.below(static_cast<std::uint32_t>(boxes.size()))];
      }
      Point low, high;
      bool fits = true;
      for (int k = 0; k < 3; ++k) {
        const auto room = static_cast<std::uint32_t>(around[1][k] - around[0][k]);
        fits = fits && room > 2;
        if (!fits) break;
        const std::uint32_t from = 1 + random.below(std::min(room - 2, 4u));
        low[k] = around[0][k] + from;
        high[k] = around[1][k] - 1 - random.below(std::min(room - from - 1, 4u));
      }
      if (!fits) continue;
      const auto holds = [](const std::array<Point, 2>& outer, const std::array<Point, 2>& inner) {
        return (outer[0].array() < inner[0].array()).all() &&
               (outer[1].array() > inner[1].array()).all();
      };
      const std::array<Point, 2> box = {low, high};
      if (std::ranges::all_of(boxes, [&](const std::array<Point, 2>& other) {
            return holds(other, box) || holds(box, other) ||
                   (other[0].array() > high.array()).any() ||
                   (other[1].array() < low.array()).any();
          })) {
        boxes.push_back(box);
      }
    }
    TriangleMesh mesh;
    for (const auto& [low, high] : boxes) {
      TriangleMesh box;
      for (unsigned v = 0; v < 8; ++v) {
        box.vertices.emplace_back((v & 1) != 0 ? high.x() : low.x(),
                                  (v & 2) != 0 ? high.y() : low.y(),
                                  (v & 4) != 0 ? high.z() : low.z());
      }
      box.triangles = faces;
      if (random.below(2) == 0) {
        for (Triangle& t : box.triangles) std::swap(t[0], t[1]);
      }
      append(mesh, box);
    }
    orient_outward(mesh);
    const std::vector<double> found = volumes(mesh, boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto depth = std::ranges::count_if(boxes, [&](const std::array<Point, 2>& other) {
        return (other[0].array() < boxes[i][0].array()).all() &&
               (other[1].array() > boxes[i][1].array()).all();
      });
      EXPECT_EQ(found[i] > 0, depth % 2 == 0);
      ++seen[static_cast<std::size_t>(depth % 2)];
    }
  }
  EXPECT_GT(seen[0], 50u);
  EXPECT_GT(seen[1], 50u);
}

TEST(OrientOutward, LeavesMeshesWithoutVolumeAlone) {
  TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}, {1, 1, 2}}};
  const std::vector<Triangle> before = flat.triangles;
  orient_outward(flat);
  EXPECT_EQ(flat.triangles, before);
  TriangleMesh empty;
  orient_outward(empty);
}

}  // namespace
}  // namespace emax::test
