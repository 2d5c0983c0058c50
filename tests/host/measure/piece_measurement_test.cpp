#include "host/measure/piece_measurement.h"

#include <gtest/gtest.h>

#include "host/engine/error_engine.h"
#include "host/measure/mesh_extent.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// In pieces of any size each point has the bits that it has in the whole cloud.
TEST(PieceMeasurement, GivesTheBitsOfTheWhole) {
  for (const test::Stimulus& s : test::all_stimuli(95)) {
    SCOPED_TRACE(s.name + ", seed 95");
    const PreparedCloud cloud(s.cloud);
    ErrorEngine engine(cloud);
    const PreparedMesh mesh(s.mesh(), cloud.normalization());
    const std::vector<std::uint32_t> whole = engine.squared_distances(mesh);
    for (const bool brute_force : {false, true}) {
      const PieceMeasurement measurement(s.mesh(), cloud.normalization(), brute_force, 2);
      for (const std::size_t size : {std::size_t{1}, std::size_t{33}, s.cloud.size()}) {
        std::vector<std::uint32_t> pieces;
        for (std::size_t first = 0; first < s.cloud.size(); first += size) {
          const std::size_t count = std::min(size, s.cloud.size() - first);
          for (const std::uint32_t bits :
               measurement.squared_distances(std::span(s.cloud).subspan(first, count))) {
            pieces.push_back(bits);
          }
        }
        EXPECT_EQ(pieces, whole) << "pieces of " << size << (brute_force ? ", every pair" : "");
      }
    }
  }
}

// The least distances from the parts of a mesh are those from the whole, to the bit, whatever the
// size and the order of the parts.
TEST(PieceMeasurement, LowersToTheBitsOfTheWholeMesh) {
  for (const test::Stimulus& s : test::all_stimuli(97)) {
    SCOPED_TRACE(s.name + ", seed 97");
    const Normalization normalization = normalization_of(s.cloud);
    const MeshView mesh = s.mesh();
    for (const bool brute_force : {false, true}) {
      const std::vector<std::uint32_t> whole =
          PieceMeasurement(mesh, normalization, brute_force, 2).squared_distances(s.cloud);
      for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{50}}) {
        if (mesh.triangles.size() > 300 * size) continue;
        std::vector<std::uint32_t> least(s.cloud.size(), kNothingMet);
        for (std::size_t end = mesh.triangles.size(); end > 0; end -= std::min(end, size)) {
          const std::size_t first = end - std::min(end, size);
          const MeshView part{mesh.vertices, mesh.triangles.subspan(first, end - first)};
          PieceMeasurement(part, normalization, brute_force, 1).lower(s.cloud, least);
        }
        EXPECT_EQ(least, whole) << "parts of " << size << (brute_force ? ", every pair" : "");
      }
    }
  }
}

TEST(MeshExtent, OfPartsIsThatOfTheWhole) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 300, 98);
  const Normalization normalization = normalization_of(s.cloud);
  const MeshView mesh = s.mesh();
  const MeshExtent whole(mesh, normalization);
  const std::size_t half = mesh.triangles.size() / 2;
  MeshExtent joined({mesh.vertices, mesh.triangles.subspan(half)}, normalization);
  joined.join(MeshExtent({mesh.vertices, mesh.triangles.first(half)}, normalization));
  EXPECT_EQ(joined.lower, whole.lower);
  EXPECT_EQ(joined.upper, whole.upper);
  EXPECT_EQ(joined.longest_edge, whole.longest_edge);
  EXPECT_EQ(joined.farthest, whole.farthest);
}

TEST(PieceMeasurement, EndsWhereItIsInterrupted) {
  const test::Stimulus s = test::bumpy_sphere(12, 16, 300, 96);
  const PieceMeasurement measurement(s.mesh(), normalization_of(s.cloud), false, 1);
  EXPECT_THROW(measurement.squared_distances(s.cloud, [] { return true; }), Interrupted);
}

}  // namespace
}  // namespace emax
