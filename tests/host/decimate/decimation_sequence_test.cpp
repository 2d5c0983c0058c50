#include "host/decimate/decimation_sequence.h"

#include <gtest/gtest.h>

#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

using Effort = DecimationSettings::Effort;

void expect_within(const TriangleMesh& mesh, std::span<const Point> cloud,
                   const TriangleMesh& reference, const DecimationSettings& settings) {
  EXPECT_TRUE(check_mesh(mesh.view()).valid());
  EXPECT_TRUE(certify(cloud, mesh.view()).within(settings.epsilon));
  SurfaceDistanceOptions options;
  options.relative = 0;
  options.limit = settings.epsilon;
  EXPECT_TRUE(
      !settings.two_sided ||
      surface_distance(mesh.view(), ExactMesh(reference.view()), options).within(settings.epsilon));
}

TEST(DecimationSequence, ItsCutsAreNearlyAsGoodAsDirectRuns) {
  const TriangleMesh mesh = bumpy(24, 36);
  DecimationSequence sequence(mesh, mesh.vertices);
  const BoundedDecimator direct(mesh, mesh.vertices);
  for (const bool two_sided : {true, false}) {
    for (const double epsilon : {0.02, 0.04}) {
      DecimationSettings settings = with(epsilon);
      settings.two_sided = two_sided;
      const TriangleMesh cut = sequence.cut(settings).mesh;
      expect_within(cut, mesh.vertices, mesh, settings);
      EXPECT_LE(static_cast<double>(cut.triangles.size()),
                1.2 * static_cast<double>(direct.run(settings).mesh.triangles.size()));
    }
  }
  EXPECT_GT(sequence.levels(), 2u);
}

TEST(DecimationSequence, ACutDoesNotDependOnTheCutsBefore) {
  const TriangleMesh mesh = bumpy(20, 30);
  DecimationSequence first(mesh, mesh.vertices), second(mesh, mesh.vertices);
  const TriangleMesh fine = first.cut(with(0.02)).mesh, coarse = first.cut(with(0.05)).mesh;
  EXPECT_TRUE(same_bytes(second.cut(with(0.05)).mesh, coarse));
  EXPECT_TRUE(same_bytes(second.cut(with(0.02)).mesh, fine));
  EXPECT_TRUE(same_bytes(first.cut(with(0.02)).mesh, fine));
}

// Points off the surface, farther than the finest mesh allows and nearer than the cut does.
TEST(DecimationSequence, KeepsPointsThatFinerMeshesDoNotReach) {
  const TriangleMesh mesh = bumpy(24, 36);
  std::vector<Point> cloud = mesh.vertices;
  for (std::size_t v = 50; v < mesh.vertices.size(); v += 150) {
    cloud.push_back(mesh.vertices[v] * (1 + 0.018 / mesh.vertices[v].norm()));
  }
  DecimationSequence sequence(mesh, cloud);
  const DecimatedMesh cut = sequence.cut(with(0.02));
  EXPECT_TRUE(cut.left_out.empty());
  expect_within(cut.mesh, cloud, mesh, with(0.02));
}

TEST(DecimationSequence, StopsWithAMeshThatHolds) {
  const TriangleMesh mesh = bumpy(24, 36);
  for (const int allowed : {0, 3, 20, 60}) {
    int polls = 0;
    DecimationSettings settings = with(0.04);
    settings.interrupted = [&] { return ++polls > allowed; };
    const DecimatedMesh result = DecimationSequence(mesh, mesh.vertices).cut(settings);
    EXPECT_TRUE(result.interrupted);
    expect_within(result.mesh, mesh.vertices, mesh, settings);
  }
}

}  // namespace
}  // namespace emax::test
