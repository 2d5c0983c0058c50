#include "host/decimate/certified_decimation.h"

#include <gtest/gtest.h>

#include "surfaces.h"

namespace emax::test {
namespace {

using Fault = DecimationSettings::Fault;

CertifiedDecimationSettings with(double epsilon, MeshFormat format = MeshFormat::kPly) {
  CertifiedDecimationSettings settings;
  settings.decimation.epsilon = epsilon;
  settings.decimation.effort = DecimationSettings::Effort::kCollapse;
  settings.format = format;
  settings.whole_reference = true;
  return settings;
}

// From scratch, on what the file would give back.
void expect_certified(const CertifiedDecimation& result, const TriangleMesh& reference,
                      const CertifiedDecimationSettings& settings) {
  const double epsilon = settings.decimation.epsilon;
  EXPECT_TRUE(same_bytes(as_stored(result.mesh, settings.format), result.mesh));
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
    for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kStl}) {
      const CertifiedDecimationSettings settings = with(0.02, format);
      const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
      expect_certified(result, mesh, settings);
      EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size());
    }
  }
}

// Few vertices far apart: the inside of the reference is what is missed.
TEST(CertifiedDecimation, MendsWhatIsMissedBetweenThePoints) {
  CertifiedDecimationSettings settings = with(0.02);
  int repairs = 0;
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
      repairs += result.repairs;
    }
  }
  EXPECT_GT(repairs, 0);
}

TEST(CertifiedDecimation, NeverHandsOutWhatAFaultyDecimatorMade) {
  const TriangleMesh sheets = joined(sheet(16, 0.4), sheet(16, 0.4), {0, 0, 0.02});
  const TriangleMesh sphere = bumpy(16, 24);
  const auto run = [](const TriangleMesh& mesh, Fault fault) {
    CertifiedDecimationSettings settings = with(0.05);
    settings.decimation.fault = fault;
    settings.decimation.normal_cosine = -1;
    const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
    expect_certified(result, mesh, settings);
    return result.repairs;
  };
  EXPECT_EQ(run(sheets, Fault::kNone), 0);
  EXPECT_GT(run(sheets, Fault::kSkipsIntersections), 0);
  EXPECT_GT(run(sheets, Fault::kSkipsBackBound), 0);
  EXPECT_GT(run(sphere, Fault::kSkipsPoints), 0);
}

TEST(CertifiedDecimation, IsCertifiedWhereverItIsInterrupted) {
  const TriangleMesh mesh = bumpy(24, 40);
  for (const int allowed : {0, 5, 20, 60}) {
    int polls = 0;
    CertifiedDecimationSettings settings = with(0.05);
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
  CertifiedDecimationSettings settings = with(0.05);
  settings.whole_reference = false;
  const CertifiedDecimation result = decimate_certified(mesh, cloud, settings);
  EXPECT_EQ(result.points.excluded,
            std::vector<std::uint32_t>{static_cast<std::uint32_t>(cloud.size() - 1)});
  EXPECT_TRUE(result.points.within(0.05));
  EXPECT_GT(result.points.e_max_upper_all, 3);
}

}  // namespace
}  // namespace emax::test
