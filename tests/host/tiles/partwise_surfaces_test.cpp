// Distances between a mesh in memory and one in parts, beside those of both in memory.
#include "host/tiles/partwise_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "host/files/mesh_file.h"
#include "host/geometry/triangle_mesh.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

TriangleMesh sphere(int rows, int columns, std::uint64_t seed) {
  const test::Stimulus s = test::bumpy_sphere(rows, columns, 0, seed);
  return {s.vertices, s.triangles};
}

// A square of n by n fields that is wavy, or flat and of two triangles.
TriangleMesh field(std::uint32_t n, double height) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double x = 10.0 / n * i, y = 10.0 / n * j;
      mesh.vertices.emplace_back(x, y, height * std::sin(3 * x) * std::cos(2 * y));
      if (i == n || j == n) continue;
      const std::uint32_t at = i * (n + 1) + j;
      mesh.triangles.push_back({at, at + n + 1, at + n + 2});
      mesh.triangles.push_back({at, at + n + 2, at + 1});
    }
  }
  return mesh;
}

struct Pair {
  const char* name;
  TriangleMesh in_memory, in_parts;
};

std::vector<Pair> pairs() {
  return {{"coarse to fine", sphere(12, 16, 421), sphere(40, 50, 421)},
          {"fine to coarse", sphere(40, 50, 422), sphere(12, 16, 422)},
          {"flat to wavy", field(1, 0), field(50, 0.1)},
          {"wavy to flat", field(50, 0.1), field(1, 0)},
          {"other places", sphere(12, 16, 423), field(20, 0.1)}};
}

class PartwiseSurfaces {
 public:
  explicit PartwiseSurfaces(const TriangleMesh& mesh) { write_mesh(folder_ / "mesh.ply", mesh); }

  SurfaceDistance to(const TriangleMesh& mesh, double limit, std::uint64_t memory) const {
    return distance_to_parts(
        mesh.view(), parts(),
        {.limit = limit, .memory = memory, .threads = memory > 500000 ? 2u : 1u});
  }
  SurfaceDistance from(const TriangleMesh& mesh, double limit, std::uint64_t memory) const {
    return distance_from_parts(parts(), ExactMesh(mesh.view()), {.limit = limit, .memory = memory});
  }

 private:
  MeshParts parts() const { return MeshParts(folder_ / "mesh.ply"); }

  test::TemporaryFolder folder_;
};

void expect_decided(const SurfaceDistance& found, double limit, bool expected) {
  EXPECT_EQ(found.within(limit), expected) << limit << ": " << found.lower << " " << found.upper;
  EXPECT_EQ(found.lower <= limit, expected) << limit << ": " << found.lower << " " << found.upper;
}

TEST(PartwiseSurfaces, DecideAsInMemory) {
  for (const Pair& p : pairs()) {
    SCOPED_TRACE(p.name);
    const PartwiseSurfaces parts(p.in_parts);
    const double to =
        surface_distance(p.in_memory.view(), ExactMesh(p.in_parts.view()), {.relative = 1e-10})
            .upper;
    const double from =
        surface_distance(p.in_parts.view(), ExactMesh(p.in_memory.view()), {.relative = 1e-10})
            .upper;
    for (const double factor : {0.5, 0.999, 1 - 1e-6, 1 + 1e-6, 1.001, 2.0}) {
      for (const std::uint64_t memory : {500000u, 1000000u, 100000000u}) {
        SCOPED_TRACE(std::to_string(memory));
        expect_decided(parts.to(p.in_memory, factor * to, memory), factor * to, factor > 1);
        expect_decided(parts.from(p.in_memory, factor * from, memory), factor * from, factor > 1);
      }
    }
  }
}

// The mesh lies in the reference; roundings of the cuts alone are left.
TEST(PartwiseSurfaces, OfOneAndTheSame) {
  const TriangleMesh fine = field(60, 0), coarse = field(1, 0), wavy = sphere(40, 50, 424);
  EXPECT_EQ(PartwiseSurfaces(fine).to(coarse, 0, 300000).lower, 0);
  EXPECT_TRUE(PartwiseSurfaces(fine).to(coarse, 1e-7, 300000).within(1e-7));
  EXPECT_TRUE(PartwiseSurfaces(fine).from(coarse, 0, 300000).within(1e-7));
  EXPECT_TRUE(PartwiseSurfaces(wavy).to(wavy, 0, 300000).within(1e-7));
  EXPECT_EQ(PartwiseSurfaces(wavy).to(wavy, 0, 300000).lower, 0);
}

// Far from the origin, where coordinates have few digits left for a small mesh.
TEST(PartwiseSurfaces, OfCoordinatesThatAreRoundings) {
  const auto moved = [](TriangleMesh mesh) {
    for (Point& p : mesh.vertices) p = 1e-6 * p + Point::Constant(1e8);
    return mesh;
  };
  const TriangleMesh coarse = moved(field(1, 0)), fine = moved(field(60, 0));
  const SurfaceDistance to = PartwiseSurfaces(fine).to(coarse, 1e-6, 3000000);
  EXPECT_TRUE(to.within(2e-6));  // the limit and the roundings of cuts
  EXPECT_EQ(to.lower, 0);
  EXPECT_TRUE(PartwiseSurfaces(fine).from(coarse, 1e-6, 3000000).within(1e-6));
}

TEST(PartwiseSurfaces, NameWhatTheMemoryDoesNotHold) {
  const TriangleMesh wavy = sphere(40, 50, 425);
  const std::string message =
      test::message_of([&] { PartwiseSurfaces(wavy).to(wavy, 10, 100000); });
  EXPECT_NE(message.find("mesh.ply: 3900 of its triangles come near to one part of the mesh, more "
                         "than the memory holds; give more --memory"),
            std::string::npos)
      << message;
}

TEST(PartwiseSurfacesFault, TrianglesBesideACellThatAreForgottenAreNoticed) {
  const TriangleMesh coarse = sphere(12, 16, 426), fine = sphere(40, 50, 426);
  const double to =
      surface_distance(coarse.view(), ExactMesh(fine.view()), {.relative = 1e-10}).upper;
  const DeliberateFault fault(Fault::kForgetsReach);
  EXPECT_FALSE(PartwiseSurfaces(fine).to(coarse, 1.001 * to, 300000).within(1.001 * to));
}

}  // namespace
}  // namespace emax
