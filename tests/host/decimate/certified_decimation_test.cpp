#include "host/decimate/certified_decimation.h"

#include <gtest/gtest.h>

#include "sw_model/base/deliberate_fault.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

CertifiedDecimationSettings certified_with(double epsilon, Storage storage = Storage::kExact) {
  CertifiedDecimationSettings settings;
  settings.decimation.epsilon = epsilon;
  settings.decimation.effort = DecimationSettings::Effort::kCollapse;
  settings.storage = storage;
  return settings;
}

// From scratch, on what the file would give back.
void expect_certified(const CertifiedDecimation& result, const TriangleMesh& reference,
                      const CertifiedDecimationSettings& settings) {
  const double epsilon = settings.decimation.epsilon;
  EXPECT_TRUE(same_bytes(as_stored(result.mesh, settings.storage), result.mesh));
  EXPECT_TRUE(check_mesh(result.mesh.view()).valid());
  EXPECT_TRUE(certify(reference.vertices, result.mesh.view()).within(epsilon));
  SurfaceDistanceOptions decide;
  decide.relative = 0;
  decide.limit = epsilon;
  const auto distance = [&](const TriangleMesh& from, const TriangleMesh& to) {
    return surface_distance(from.view(), ExactMesh(to.view()), decide);
  };
  EXPECT_TRUE(distance(result.mesh, reference).within(epsilon));
  EXPECT_TRUE(distance(reference, result.mesh).within(epsilon));
  EXPECT_TRUE(result.mesh_to_reference->within(epsilon));
  EXPECT_TRUE(result.reference_to_mesh->within(epsilon));
}

TEST(CertifiedDecimation, BoundsBothSurfacesAsStored) {
  for (const TriangleMesh& mesh : {bumpy(24, 40), sheet(24, 0.3), cube(4)}) {
    for (const Storage storage : {Storage::kExact, Storage::kBinary32}) {
      const CertifiedDecimationSettings settings = certified_with(0.02, storage);
      const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
      expect_certified(result, mesh, settings);
      EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size());
    }
  }
}

// Few vertices far apart: the inside of the reference would be missed between the points.
TEST(CertifiedDecimation, KeepsWhatLiesBetweenThePointsWithoutRepair) {
  CertifiedDecimationSettings settings = certified_with(0.02);
  for (const double epsilon : {0.01, 0.02, 0.05, 0.1}) {
    for (const TriangleMesh& mesh : {bumpy(12, 18), sheet(10, 0.4), bumpy(8, 12)}) {
      settings.decimation.epsilon = epsilon;
      settings.decimation.epsilon_back = 4 * epsilon;
      const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
      settings.decimation.epsilon_back = 0;
      EXPECT_TRUE(result.points.within(epsilon) && result.validity.valid());
      EXPECT_TRUE(result.mesh_to_reference->within(4 * epsilon));
      EXPECT_TRUE(result.reference_to_mesh->within(epsilon));
      EXPECT_LE(result.mesh.triangles.size(), mesh.triangles.size());
      EXPECT_EQ(result.repairs, 0);
    }
  }
}

// Two spheres through each other: the pairs of triangles that meet stay, and become no more.
TEST(CertifiedDecimation, KeepsASurfaceThatIntersectsItself) {
  const TriangleMesh crossing = joined(bumpy(16, 24), bumpy(16, 24), {0.7, 0.1, 0.2});
  const MeshValidity before = check_mesh(crossing.view());
  ASSERT_GT(before.self_intersections, 20u);
  const CertifiedDecimation result =
      decimate_certified(crossing, crossing.vertices, certified_with(0.05));
  EXPECT_EQ(result.repairs, 0);
  EXPECT_LT(result.mesh.triangles.size(), crossing.triangles.size() / 2);
  EXPECT_LE(result.validity.self_intersections, before.self_intersections);
  EXPECT_EQ(result.validity.components, 2u);
  EXPECT_EQ(result.validity.boundary_edges, 0u);
  EXPECT_TRUE(result.reference_to_mesh->within(0.05));
}

TEST(CertifiedDecimationFault, IsNeverHandedOut) {
  const TriangleMesh sheets = joined(sheet(16, 0.4), sheet(16, 0.4), {0, 0, 0.02});
  const TriangleMesh sphere = bumpy(16, 24);
  const auto run = [](const TriangleMesh& mesh, Fault fault, double back = 0.05) {
    CertifiedDecimationSettings settings = certified_with(0.05);
    settings.decimation.epsilon_back = back;
    const DeliberateFault broken(fault);
    settings.decimation.normal_cosine = -1;
    const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
    if (back == 0.05) expect_certified(result, mesh, settings);
    EXPECT_TRUE(result.reference_to_mesh->within(0.05));
    return result.repairs;
  };
  EXPECT_EQ(run(sheets, Fault::kNone), 0);
  EXPECT_GT(run(sheets, Fault::kSkipsIntersections), 0);
  EXPECT_GT(run(sheets, Fault::kSkipsBackBound), 0);
  // Few vertices far apart, and room for the mesh between them.
  EXPECT_EQ(run(bumpy(8, 12), Fault::kNone, 0.2), 0);
  EXPECT_GT(run(bumpy(8, 12), Fault::kSkipsReference, 0.2), 0);
}

TEST(CertifiedDecimation, IsCertifiedWhereverItIsInterrupted) {
  const TriangleMesh mesh = bumpy(24, 40);
  for (const int allowed : {0, 5, 20, 60}) {
    int polls = 0;
    CertifiedDecimationSettings settings = certified_with(0.05);
    settings.decimation.effort = DecimationSettings::Effort::kDeep;
    settings.decimation.interrupted = [&] { return ++polls > allowed; };
    const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
    EXPECT_TRUE(result.interrupted);
    expect_certified(result, mesh, settings);
  }
}

TEST(CertifiedDecimation, NamesThePointsThatTheReferenceMisses) {
  const TriangleMesh mesh = bumpy(16, 24);
  std::vector<Point> cloud = mesh.vertices;
  cloud.push_back({5, 0, 0});
  CertifiedDecimationSettings settings = certified_with(0.05);
  const CertifiedDecimation result = decimate_certified(mesh, cloud, settings);
  EXPECT_EQ(result.points.excluded,
            std::vector<std::uint32_t>{static_cast<std::uint32_t>(cloud.size() - 1)});
  EXPECT_TRUE(result.points.within(0.05));
  EXPECT_GT(result.points.e_max_upper_all, 3);
}

}  // namespace
}  // namespace emax::test
