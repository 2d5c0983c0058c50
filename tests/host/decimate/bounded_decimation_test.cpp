#include "host/decimate/bounded_decimation.h"

#include <gtest/gtest.h>

#include <string_view>

#include "host/decimate/back_bound.h"
#include "host/geometry/mesh_validity.h"
#include "host/surface/manifold_part.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

using Effort = DecimationSettings::Effort;

struct Verdict {
  bool forward, back, valid;
  bool operator==(const Verdict&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Verdict& v) {
  return out << "forward " << v.forward << " back " << v.back << " valid " << v.valid;
}
constexpr Verdict kAllHolds = {true, true, true};

// Nothing here is of the decimator's own: certificate, surface distance, exact validity.
Verdict verdict(const TriangleMesh& mesh, std::span<const Point> cloud,
                const TriangleMesh& reference, double epsilon,
                std::span<const std::uint32_t> left_out = {}) {
  SurfaceDistanceOptions options;
  options.relative = 0;
  options.limit = epsilon;
  return {certify(cloud, mesh.view(), left_out).within(epsilon),
          surface_distance(mesh.view(), ExactMesh(reference.view()), options).within(epsilon),
          check_mesh(mesh.view()).valid()};
}

std::vector<TriangleMesh> surfaces() {
  const TriangleMesh open = manifold_part(without_vertex(bumpy(24, 40), 444)).mesh;
  return {bumpy(24, 40), sheet(24, 0.3), open, cube(6), joined(bumpy(20, 30), cube(4), {4, 0, 0})};
}

TEST(BoundedDecimator, KeepsBothBoundsAndTheTopology) {
  for (const TriangleMesh& mesh : surfaces()) {
    const MeshValidity before = check_mesh(mesh.view());
    for (const double epsilon : {0.005, 0.03}) {
      for (const Effort effort : {Effort::kCollapse, Effort::kRelax}) {
        const BoundedDecimator decimator(mesh, mesh.vertices);
        const DecimatedMesh result = decimator.run(with(epsilon, effort));
        EXPECT_EQ(verdict(result.mesh, mesh.vertices, mesh, epsilon), kAllHolds);
        EXPECT_TRUE(result.left_out.empty());
        EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size());
        const MeshValidity after = check_mesh(result.mesh.view());
        EXPECT_EQ(after.components, before.components);
        EXPECT_EQ(after.boundary_edges > 0, before.boundary_edges > 0);
      }
    }
  }
}

TEST(BoundedDecimator, OneSidedKeepsThePointsWithFewerTriangles) {
  const TriangleMesh mesh = bumpy(30, 50);
  DecimationSettings settings = with(0.02, Effort::kDeep);
  const BoundedDecimator decimator(mesh, mesh.vertices);
  const std::size_t both = decimator.run(settings).mesh.triangles.size();
  settings.two_sided = false;
  const TriangleMesh one = decimator.run(settings).mesh;
  EXPECT_LT(one.triangles.size(), both);
  const Verdict v = verdict(one, mesh.vertices, mesh, 0.02);
  EXPECT_TRUE(v.forward && v.valid);
}

TEST(BoundedDecimator, LeavesACubeItsTwelveTriangles) {
  const TriangleMesh mesh = cube(6);
  const TriangleMesh result =
      BoundedDecimator(mesh, mesh.vertices).run(with(1e-3, Effort::kDeep)).mesh;
  EXPECT_EQ(result.triangles.size(), 12u);
}

TEST(BoundedDecimator, MoreEffortAndMoreErrorLeaveFewerTriangles) {
  const TriangleMesh mesh = bumpy(30, 50);
  const BoundedDecimator decimator(mesh, mesh.vertices);
  const auto left = [&](double epsilon, Effort effort) {
    return decimator.run(with(epsilon, effort)).mesh.triangles.size();
  };
  EXPECT_LT(left(0.01, Effort::kRelax), left(0.01, Effort::kCollapse));
  EXPECT_LT(left(0.01, Effort::kDeep), left(0.01, Effort::kRelax));
  EXPECT_LT(left(0.03, Effort::kRelax), left(0.01, Effort::kRelax));
}

// Told by the passes: only exchanges of triangles loosen the limits.
TEST(BoundedDecimator, EvensTheErrorOutWhereTheReferenceIsSmooth) {
  const TriangleMesh mesh = bumpy(30, 50);
  const BoundedDecimator decimator(mesh, mesh.vertices);
  const auto evens_out = [&](double epsilon, Effort effort, bool two_sided) {
    DecimationSettings settings = with(epsilon, effort);
    settings.two_sided = two_sided;
    bool any = false;
    settings.progress = [&](const char* pass, std::size_t, std::size_t) {
      any = any || std::string_view(pass) == "loose collapses";
    };
    decimator.run(mesh, settings);
    return any;
  };
  const double rise = BackBound(mesh, 1).usual_rise();
  EXPECT_TRUE(evens_out(rise, Effort::kRelax, true));
  EXPECT_FALSE(evens_out(rise / 2, Effort::kRelax, true));
  EXPECT_FALSE(evens_out(rise, Effort::kRelax, false));
  EXPECT_TRUE(evens_out(rise / 2, Effort::kDeep, true));
}

TEST(BoundedDecimator, RepeatsItsBytes) {
  const TriangleMesh mesh = bumpy(24, 36);
  const BoundedDecimator decimator(mesh, mesh.vertices);
  EXPECT_TRUE(same_bytes(decimator.run(with(0.02, Effort::kDeep)).mesh,
                         decimator.run(with(0.02, Effort::kDeep)).mesh));
}

TEST(BoundedDecimator, KeepsItsBoundsFarFromTheOrigin) {
  TriangleMesh mesh = bumpy(24, 36);
  for (Point& p : mesh.vertices) p += Point(1e7, -1e7, 5e6);
  const TriangleMesh result = BoundedDecimator(mesh, mesh.vertices).run(with(0.02)).mesh;
  EXPECT_EQ(verdict(result, mesh.vertices, mesh, 0.02), kAllHolds);
  EXPECT_LT(result.triangles.size(), mesh.triangles.size() / 2);
}

TEST(BoundedDecimator, MayStartFromAnotherMeshThanItsReference) {
  const TriangleMesh reference = bumpy(30, 50);
  const BoundedDecimator decimator(reference, reference.vertices);
  const TriangleMesh start = decimator.run(with(0.005, Effort::kCollapse)).mesh;
  const TriangleMesh result = decimator.run(start, with(0.02)).mesh;
  EXPECT_LT(result.triangles.size(), start.triangles.size());
  EXPECT_EQ(verdict(result, reference.vertices, reference, 0.02), kAllHolds);
}

TEST(BoundedDecimator, StopsWithAMeshThatHolds) {
  const TriangleMesh mesh = bumpy(30, 50);
  std::size_t last = mesh.triangles.size() + 1;
  for (const int allowed : {0, 10, 40, 80, 160}) {
    int polls = 0;
    DecimationSettings settings = with(0.02, Effort::kDeep);
    settings.interrupted = [&] { return ++polls > allowed; };
    const DecimatedMesh result = BoundedDecimator(mesh, mesh.vertices).run(settings);
    EXPECT_TRUE(result.interrupted);
    EXPECT_EQ(polls, allowed + 1);
    EXPECT_EQ(verdict(result.mesh, mesh.vertices, mesh, 0.02), kAllHolds);
    EXPECT_LE(result.mesh.triangles.size(), last);
    last = result.mesh.triangles.size();
  }
}

TEST(BoundedDecimatorFault, EachIsCaught) {
  const TriangleMesh sheets = joined(sheet(24, 0.4), sheet(24, 0.4), {0, 0, 0.02});
  const TriangleMesh sphere = bumpy(20, 30);
  const auto with_fault = [](const TriangleMesh& mesh, Fault fault, bool two_sided) {
    DecimationSettings settings = with(0.05, Effort::kCollapse);
    const DeliberateFault broken(fault);
    settings.two_sided = two_sided;
    settings.normal_cosine = -1;
    const TriangleMesh result = BoundedDecimator(mesh, mesh.vertices).run(settings).mesh;
    return verdict(result, mesh.vertices, mesh, 0.05);
  };
  EXPECT_EQ(with_fault(sheets, Fault::kNone, true), kAllHolds);
  EXPECT_EQ(with_fault(sphere, Fault::kNone, true), kAllHolds);
  EXPECT_FALSE(with_fault(sheets, Fault::kSkipsIntersections, true).valid);
  EXPECT_FALSE(with_fault(sheets, Fault::kSkipsBackBound, true).back);
  // The bounds are alike where points are dense: alone, the one shows.
  EXPECT_FALSE(with_fault(sphere, Fault::kSkipsPoints, false).forward);
}

TEST(BoundedDecimator, SaysWhatIsWrongWithItsInput) {
  const TriangleMesh mesh = bumpy(10, 16);
  const auto message = [&](const auto& run) -> std::string {
    try {
      run();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  const auto run_with = [&](double epsilon) {
    return message([&] { BoundedDecimator(mesh, mesh.vertices).run(with(epsilon)); });
  };
  EXPECT_NE(run_with(0).find("positive"), std::string::npos);
  EXPECT_NE(run_with(-1).find("positive"), std::string::npos);
  EXPECT_NE(run_with(1e-13).find("roundings"), std::string::npos);
  const auto reference_of = [&](const TriangleMesh& m, const std::vector<Point>& cloud) {
    return message([&] { reference_surface(m, cloud, 0.01); });
  };
  EXPECT_NE(reference_of({}, mesh.vertices).find("no triangle"), std::string::npos);
  EXPECT_NE(reference_of(mesh, {}).find("no point"), std::string::npos);
  EXPECT_NE(reference_of(mesh, moved(mesh.vertices, {9, 0, 0})).find("does not belong"),
            std::string::npos);
  TriangleMesh broken = mesh;
  broken.triangles[3][1] = 5000;
  EXPECT_NE(reference_of(broken, mesh.vertices).find("vertex 5000"), std::string::npos);
  broken = mesh;
  broken.vertices[7][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(reference_of(broken, mesh.vertices).find("vertex 7"), std::string::npos);
}

// So small that nothing can go: the mesh stays as it is.
TEST(BoundedDecimator, LeavesTheMeshWhereTheErrorIsTooSmall) {
  const TriangleMesh mesh = bumpy(10, 16);
  const TriangleMesh result = BoundedDecimator(mesh, mesh.vertices).run(with(1e-9)).mesh;
  EXPECT_EQ(result.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(verdict(result, mesh.vertices, mesh, 1e-9), kAllHolds);
}

TEST(ReferenceSurface, IsValidWhateverTheMesh) {
  const TriangleMesh whole = bumpy(20, 30);
  TriangleMesh turned = whole;
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3) {
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  }
  TriangleMesh soup;  // every triangle with vertices of its own
  for (const Triangle& t : whole.triangles) {
    const auto at = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(whole.vertices[v]);
    soup.triangles.push_back({at, at + 1, at + 2});
  }
  TriangleMesh fin = whole;
  fin.vertices.push_back({0, 0, 3});
  fin.triangles.push_back({0, 1, static_cast<std::uint32_t>(whole.vertices.size())});
  TriangleMesh doubled = whole;
  doubled.triangles.insert(doubled.triangles.end(), whole.triangles.begin(),
                           whole.triangles.begin() + 40);
  TriangleMesh degenerate = whole;
  degenerate.triangles.push_back({5, 5, 9});
  degenerate.triangles.push_back({5, 9, 9});
  const TriangleMesh crossing = joined(whole, whole, {0.7, 0.1, 0.2});
  for (const TriangleMesh& mesh : {turned, soup, fin, doubled, degenerate, crossing}) {
    const ReferenceSurface reference = reference_surface(mesh, whole.vertices, 0.01);
    EXPECT_TRUE(check_mesh(reference.mesh.view()).valid());
    const DecimatedMesh result =
        BoundedDecimator(reference.mesh, whole.vertices).run(with(0.02, Effort::kCollapse));
    EXPECT_EQ(verdict(result.mesh, whole.vertices, reference.mesh, 0.02, result.left_out),
              kAllHolds);
  }
  EXPECT_TRUE(reference_surface(turned, whole.vertices, 0.01).dropped == 0);
  EXPECT_TRUE(reference_surface(soup, whole.vertices, 0.01).dropped == 0);
  EXPECT_EQ(reference_surface(fin, whole.vertices, 0.01).dropped, 1u);
  EXPECT_EQ(reference_surface(doubled, whole.vertices, 0.01).dropped, 40u);
}

TEST(ReferenceSurface, TakesInPointsThatTheMeshMissed) {
  // Over a face, beyond a boundary, over the surface near a corner.
  const TriangleMesh mesh = sheet(12, 0.2);
  std::vector<Point> cloud = mesh.vertices;
  cloud.push_back({0.05, 0.11, 0.4});
  cloud.push_back({1.12, 0.05, 0.1});
  cloud.push_back({-1.1, -1.1, 0});
  const ReferenceSurface reference = reference_surface(mesh, cloud, 0.02);
  EXPECT_EQ(reference.inserted, 3u);
  EXPECT_TRUE(reference.left_out.empty());
  EXPECT_TRUE(check_mesh(reference.mesh.view()).valid());
  EXPECT_TRUE(certify(cloud, reference.mesh.view()).within(0.02));
  const TriangleMesh result = BoundedDecimator(reference.mesh, cloud).run(with(0.04)).mesh;
  EXPECT_EQ(verdict(result, cloud, reference.mesh, 0.04), kAllHolds);
}

// A point in the middle of a closed box of one sheet and a second one close around it: any triangle
// to it would pass through the inner one.
TEST(ReferenceSurface, ListsThePointThatCannotBeReached) {
  TriangleMesh inner = cube(1);
  for (Point& p : inner.vertices) p *= 0.1;
  const TriangleMesh mesh = joined(cube(2), inner, Point::Zero());
  std::vector<Point> cloud = mesh.vertices;
  cloud.push_back({3, 2.9, 2.8});
  cloud.push_back({0, 0, 0});
  const ReferenceSurface reference = reference_surface(mesh, cloud, 0.01);
  EXPECT_TRUE(check_mesh(reference.mesh.view()).valid());
  const auto upper = certify(cloud, reference.mesh.view(), reference.left_out).e_max_upper;
  EXPECT_LE(upper, 0.01);
  EXPECT_EQ(reference.inserted + reference.left_out.size(), 2u);
}

}  // namespace
}  // namespace emax::test
