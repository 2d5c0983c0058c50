// What the decimator promises, as CGAL sees it, on a scan.

#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <gtest/gtest.h>

#include "host/decimate/certified_decimation.h"
#include "host/files/mesh_file.h"
#include "host/geometry/bounds.h"
#include "host/surface/manifold_part.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/cgal_mesh.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// Corners, middles and a grid inside of every triangle.
std::vector<Point> samples(const TriangleMesh& mesh, int steps) {
  std::vector<Point> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    for (int i = 0; i <= steps; ++i) {
      for (int k = 0; i + k <= steps; ++k)
        points.push_back(a + (i * (b - a) + k * (c - a)) / steps);
    }
  }
  return points;
}

void expect_as_promised(double percent, bool two_sided, std::size_t fewer_than) {
  const TriangleMesh mesh = read_mesh(EMAX_DATA_FOLDER "/bunny00.off");
  CertifiedDecimationSettings settings;
  settings.decimation.epsilon = bounds_of(mesh.vertices).width() * percent / 100;
  settings.decimation.two_sided = two_sided;
  settings.decimation.effort = DecimationSettings::Effort::kCollapse;
  const CertifiedDecimation result = decimate_certified(mesh, mesh.vertices, settings);
  EXPECT_EQ(result.repairs, 0);
  EXPECT_LT(result.mesh.triangles.size(), fewer_than);
  const double limit = settings.decimation.epsilon * (1 + 1e-12);
  const CgalMesh cgal = cgal_mesh(result.mesh);
  EXPECT_TRUE(cgal.is_valid());
  EXPECT_FALSE(pmp::does_self_intersect(cgal));
  EXPECT_LE(farthest(mesh.vertices, cgal), limit);
  if (two_sided) {
    EXPECT_LE(farthest(samples(result.mesh, 6), cgal_mesh(mesh)), limit);
    EXPECT_LE(farthest(samples(mesh, 4), cgal), limit);
  }
}

// Open and closed, of several pieces, with handles, coarse and fine, noisy and not.
TriangleMesh drawn_surface(Random& random) {
  const auto rings = 8 + random.below(16), segments = 12 + random.below(24);
  TriangleMesh mesh;
  switch (random.below(5)) {
    case 0:
      mesh = bumpy(rings, segments);
      break;
    case 1:
      mesh = sheet(segments, random.uniform(0, 0.5));
      break;
    case 2:
      mesh = joined(bumpy(rings, segments), sheet(rings, 0.3), {0.2, 0, 2.5});
      break;
    case 3: {
      mesh = sheet(segments, 0.2);
      for (std::uint32_t hole = 0; hole < 3; ++hole) {
        mesh = without_vertex(mesh, segments + 1 + random.below(segments * (segments - 2)));
      }
      break;
    }
    default:
      mesh = cube(2 + random.below(5));
  }
  const double noise = random.below(2) == 0 ? 0 : 0.1;
  const double spacing = 2.0 / segments;
  for (Point& p : mesh.vertices) {
    p += noise * spacing *
         Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  }
  return manifold_part(mesh).mesh;
}

// Tolerances from a hundredth of the spacing to ten times of it.
TEST(BoundedDecimationCgal, DrawnSurfacesKeepThreeDirectionsAndTheirTopology) {
  constexpr std::uint64_t kSeed = 23;
  Random random(kSeed);
  std::size_t before = 0, after = 0;
  for (int i = 0; i < 40; ++i) {
    const TriangleMesh mesh = drawn_surface(random);
    const double width = bounds_of(mesh.vertices).width();
    const double spacing = width / std::sqrt(static_cast<double>(mesh.vertices.size()));
    const double epsilon = std::min(spacing * std::pow(10, random.uniform(-2, 1)), 0.3 * width);
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", surface " << i << ", tolerance "
                                    << epsilon / spacing << " spacings");
    // Points between the vertices, some of them off the surface.
    std::vector<Point> cloud = mesh.vertices;
    for (const Point& p : samples(mesh, 2)) {
      if (random.below(4) == 0) {
        cloud.push_back(p + 0.4 * epsilon * Point(random.uniform(-1, 1), random.uniform(-1, 1), 0));
      }
    }
    CertifiedDecimationSettings settings;
    settings.decimation.epsilon = epsilon;
    settings.decimation.effort =
        i % 4 == 0 ? DecimationSettings::Effort::kRelax : DecimationSettings::Effort::kCollapse;
    const CertifiedDecimation result = decimate_certified(mesh, cloud, settings);
    EXPECT_EQ(result.repairs, 0);
    before += mesh.triangles.size();
    after += result.mesh.triangles.size();
    const CgalMesh made = cgal_mesh(result.mesh), reference = cgal_mesh(mesh);
    const double limit = epsilon * (1 + 1e-9);
    EXPECT_LE(farthest(cloud, made), limit);
    EXPECT_LE(farthest(samples(result.mesh, 6), reference), limit);
    EXPECT_LE(farthest(samples(mesh, 4), made), limit);
    EXPECT_EQ(topology_by_cgal(made), topology_by_cgal(reference));
    EXPECT_FALSE(pmp::does_self_intersect(made));
  }
  EXPECT_LT(after, before / 2);
}

// The deliberate fault of each direction, which that direction's check alone sees.
TEST(BoundedDecimationCgalFault, EachDirectionAloneCatchesItsOwn) {
  struct Broken {
    bool points, back, reference;
    bool operator==(const Broken&) const = default;
  };
  const auto broken_by = [](const TriangleMesh& mesh, const std::vector<Point>& cloud, Fault fault,
                            double back) {
    DecimationSettings settings;
    settings.epsilon = 0.05;
    settings.epsilon_back = back;
    settings.normal_cosine = -1;
    settings.effort = DecimationSettings::Effort::kCollapse;
    const DeliberateFault broken(fault);
    const TriangleMesh result = BoundedDecimator(mesh, cloud).run(settings).mesh;
    const CgalMesh made = cgal_mesh(result);
    return Broken{farthest(cloud, made) > 0.05,
                  farthest(samples(result, 6), cgal_mesh(mesh)) > back,
                  farthest(samples(mesh, 6), made) > 0.05};
  };
  // Points off a surface that is itself met.
  const TriangleMesh sphere = bumpy(20, 30);
  std::vector<Point> cloud = sphere.vertices;
  for (std::size_t v = 0; v < sphere.vertices.size(); v += 3) {
    cloud.push_back(1.045 * sphere.vertices[v]);
  }
  const Broken none = {false, false, false};
  EXPECT_EQ(broken_by(sphere, cloud, Fault::kNone, 0.05), none);
  EXPECT_EQ(broken_by(sphere, cloud, Fault::kSkipsPoints, 0.05), (Broken{true, false, false}));
  // A mesh that leaves the surface between two sheets.
  const TriangleMesh sheets = joined(sheet(24, 0.4), sheet(24, 0.4), {0, 0, 0.02});
  EXPECT_EQ(broken_by(sheets, sheets.vertices, Fault::kNone, 0.05), none);
  EXPECT_EQ(broken_by(sheets, sheets.vertices, Fault::kSkipsBackBound, 0.05),
            (Broken{false, true, false}));
  // Few vertices far apart.
  const TriangleMesh coarse = bumpy(8, 12);
  EXPECT_EQ(broken_by(coarse, coarse.vertices, Fault::kNone, 0.2), none);
  EXPECT_EQ(broken_by(coarse, coarse.vertices, Fault::kSkipsReference, 0.2),
            (Broken{false, false, true}));
}

TEST(BoundedDecimationCgal, BunnyTwoSided) { expect_as_promised(0.321, true, 1600); }

TEST(BoundedDecimationCgal, BunnyOneSided) { expect_as_promised(0.193, false, 2300); }

}  // namespace
}  // namespace emax::test
