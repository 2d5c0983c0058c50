// Faults and topology of meshes in parts, beside those of the same meshes in memory.
#include "host/tiles/partwise_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "host/files/mesh_file.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

constexpr std::uint64_t kEnough = std::uint64_t{1} << 26;  // bytes

PartwiseCheck check_whole(const TriangleMesh& mesh) {
  return {check_mesh(mesh.view()), topology_of(mesh.view()), mesh.triangles.size(),
          mesh.vertices.size()};
}

std::string text_of(const PartwiseCheck& c) {
  const MeshValidity& v = c.validity;
  std::string text = describe(c.topology);
  for (const std::size_t count :
       {v.boundary_edges, v.non_manifold_edges, v.non_manifold_vertices, v.inconsistent_edges,
        v.degenerate_triangles, v.self_intersections, v.self_intersecting_triangles, v.components,
        static_cast<std::size_t>(c.triangles), static_cast<std::size_t>(c.vertices)}) {
    text += ' ' + std::to_string(count);
  }
  return text;
}

// In both formats that are read in parts, with little and enough memory. Returns what was found.
PartwiseCheck expect_same(const TriangleMesh& mesh) {
  const std::uint64_t least = mesh.triangles.size() < 500 ? 0 : 60000;
  const test::TemporaryFolder folder;
  PartwiseCheck whole;
  for (const char* file : {"mesh.stl", "mesh.ply"}) {
    write_mesh(folder / file, mesh);
    whole = check_whole(read_mesh(folder / file));
    const MeshParts parts(folder / file);
    for (const std::uint64_t memory : {least, least + 5000, std::uint64_t{200000}, kEnough}) {
      const std::size_t threads = 1 + memory % 3;
      EXPECT_EQ(text_of(check_in_parts(parts, memory, threads)), text_of(whole))
          << file << " with " << memory << " bytes";
    }
  }
  return whole;
}

// Triangles over random vertices: those on a grid meet, are flat and share positions.
TriangleMesh random_triangles(std::uint32_t seed, std::uint32_t vertices, std::size_t triangles) {
  test::Random random(seed);
  TriangleMesh mesh;
  const std::uint32_t grid = 2 + seed % 9;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    Point p;
    for (int k = 0; k < 3; ++k) p[k] = random.below(grid);
    mesh.vertices.push_back(seed % 3 == 0 ? random.point(0, 1) : p);
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::uint32_t near = seed % 2 == 0 ? vertices : 6;
    const std::uint32_t a = random.below(vertices);
    const std::uint32_t b = (a + random.below(near)) % vertices;
    mesh.triangles.push_back({a, b, (a + random.below(near)) % vertices});
  }
  return mesh;
}

TEST(PartwiseCheck, CountsTheFaultsOfTheWhole) {
  PartwiseCheck sum;
  for (std::uint32_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const PartwiseCheck found = expect_same(random_triangles(seed, 4 + 11 * (seed % 7), 20 * seed));
    const MeshValidity& v = found.validity;
    MeshValidity& s = sum.validity;
    s.boundary_edges += v.boundary_edges;
    s.non_manifold_edges += v.non_manifold_edges;
    s.non_manifold_vertices += v.non_manifold_vertices;
    s.inconsistent_edges += v.inconsistent_edges;
    s.degenerate_triangles += v.degenerate_triangles;
    s.self_intersections += v.self_intersections;
    s.components += v.components;
    sum.topology.border_loops += found.topology.border_loops;
  }
  EXPECT_GT(sum.validity.boundary_edges, 100u);
  EXPECT_GT(sum.validity.non_manifold_edges, 100u);
  EXPECT_GT(sum.validity.non_manifold_vertices, 100u);
  EXPECT_GT(sum.validity.inconsistent_edges, 100u);
  EXPECT_GT(sum.validity.degenerate_triangles, 100u);
  EXPECT_GT(sum.validity.self_intersections, 100u);
  EXPECT_GT(sum.validity.components, 100u);
  EXPECT_GT(sum.topology.border_loops, 100u);
}

// A sphere with holes that folds through itself, in the order of its rows and in none.
TEST(PartwiseCheck, CountsThoseOfACrumpledSurface) {
  const test::Stimulus s = test::bumpy_sphere(40, 50, 0, 411);
  TriangleMesh mesh{s.vertices, s.triangles};
  test::Random random(411);
  std::erase_if(mesh.triangles, [&](const Triangle&) { return random.below(40) == 0; });
  for (Point& p : mesh.vertices) p += 0.06 * random.point(-1, 1);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 97) {
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  }
  const PartwiseCheck in_order = expect_same(mesh);
  EXPECT_GT(in_order.validity.self_intersections, 100u);
  EXPECT_GT(in_order.topology.border_loops, 50u);
  for (std::size_t i = mesh.triangles.size(); i-- > 1;) {
    std::swap(mesh.triangles[i], mesh.triangles[random.below(static_cast<std::uint32_t>(i))]);
  }
  EXPECT_EQ(text_of(expect_same(mesh)), text_of(in_order));
}

// Three rings in which holes are cut.
TEST(PartwiseCheck, CountsHandlesAndBorders) {
  constexpr std::uint32_t kAround = 24, kAcross = 12;
  TriangleMesh rings;
  for (std::uint32_t ring = 0; ring < 3; ++ring) {
    const auto first = static_cast<std::uint32_t>(rings.vertices.size());
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return first + i % kAround * kAcross + j % kAcross;
    };
    for (std::uint32_t i = 0; i < kAround; ++i) {
      for (std::uint32_t j = 0; j < kAcross; ++j) {
        const double a = 2 * std::numbers::pi / kAround * i;
        const double b = 2 * std::numbers::pi / kAcross * j;
        const double radius = 3 + std::cos(b);
        rings.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a),
                                    std::sin(b) + 5 * ring);
        if (i % 8 == 0 && j % 5 == 0) continue;
        rings.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        rings.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  const PartwiseCheck found = expect_same(rings);
  EXPECT_TRUE(found.validity.valid());
  EXPECT_EQ(describe(found.topology), "3 components, 27 borders, genus 3");
}

TEST(PartwiseCheck, CountsThoseOfEveryStimulus) {
  for (const test::Stimulus& s : test::all_stimuli(412)) {
    SCOPED_TRACE(s.name);
    expect_same({s.vertices, s.triangles});
  }
}

// No plane divides triangles that all meet at one vertex, or that lie one above the other.
TEST(PartwiseCheck, TakesWhatNoPlaneDivides) {
  test::Random random(413);
  TriangleMesh fan, stack;
  fan.vertices.push_back(Point::Zero());
  for (std::uint32_t i = 0; i < 300; ++i) {
    fan.vertices.push_back(random.point(-1, 1));
    fan.vertices.push_back(random.point(-1, 1));
    fan.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
    for (int k = 0; k < 3; ++k) {
      stack.vertices.push_back(random.point(0, 1e-3) + (k == 1) * Point::UnitX() +
                               (k == 2) * Point::UnitY());
    }
    stack.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_GT(expect_same(fan).validity.self_intersections, 1000u);
  EXPECT_GT(expect_same(stack).validity.self_intersections, 1000u);
}

TEST(PartwiseCheck, EndsWhenInterrupted) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(12, 16, 0, 414);
  write_mesh(folder / "mesh.ply", {s.vertices, s.triangles});
  const MeshParts parts(folder / "mesh.ply");
  for (int calls = 0; calls < 40; ++calls) {
    int left = calls;
    EXPECT_THROW(check_in_parts(parts, 30000, 1, [&] { return left-- == 0; }), Interrupted);
  }
}

TEST(PartwiseCheckFault, PairsAcrossCellsThatAreForgottenAreNoticed) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(40, 50, 0, 415);
  TriangleMesh mesh{s.vertices, s.triangles};
  test::Random random(415);
  for (Point& p : mesh.vertices) p += 0.06 * random.point(-1, 1);
  write_mesh(folder / "mesh.ply", mesh);
  const DeliberateFault fault(Fault::kOneCellEach);
  EXPECT_LT(check_in_parts(MeshParts(folder / "mesh.ply"), 200000, 1).validity.self_intersections,
            check_mesh(mesh.view()).self_intersections);
}

}  // namespace
}  // namespace emax
