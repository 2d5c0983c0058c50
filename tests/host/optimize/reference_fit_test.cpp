#include "host/optimize/reference_fit.h"

#include <gtest/gtest.h>

#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/optimize/run_bound.h"
#include "sw_model/base/error.h"
#include "sw_model/certify/exact_distance.h"
#include "tests/host/support/scanned_shapes.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kEpsilon = 0.5;

OptimizeSettings settings_for(const std::string& method) {
  OptimizeSettings settings;
  settings.method = method;
  settings.epsilon_back = kEpsilon;
  settings.jobs = 2;
  settings.output = "mesh.ply";
  return settings;
}

struct Made {
  DecimationBound bound;
  ReferenceFit fit;
};

Made reference_of(const ScanOfShape& scan, const std::string& method = kFitMethod) {
  Made made;
  ErrorConstraint constraint(scan.points, kEpsilon, scan.outliers > 0 ? 0.02 : 0);
  made.bound = decimation_bound(scan.points, constraint, settings_for(method), &made.fit);
  return made;
}

// No crack where the truth has none, its holes and borders kept, no bridge across a slot, and the
// truth within what the noise leaves.
TEST(ReferenceFit, IsTheScannedSurface) {
  for (const std::string_view shape : kScannedShapes) {
    for (const double noise : {0.0, kEpsilon / 5, kEpsilon / 2}) {
      const Density density = noise == kEpsilon / 5 ? Density::kLines : Density::kEven;
      const ScanOfShape scan =
          scan_of_shape({.shape = shape, .density = density, .noise = noise, .holes = true});
      const Made made = reference_of(scan);
      const TriangleMesh& reference = made.bound.reference;
      EXPECT_EQ(topology_of(reference.view()), topology_of(scan.surface.view())) << scan.name;
      EXPECT_TRUE(check_mesh(reference.view()).valid()) << scan.name;
      EXPECT_EQ(made.fit.best().cracks, 0u) << scan.name;
      const ExactMesh exact(reference.view());
      double squares = 0;
      const std::vector<Point> samples = points_on(scan.surface, 0.5, 1);
      for (const Point& p : samples) squares += std::pow(exact.distance(p).upper, 2);
      EXPECT_LT(std::sqrt(squares / static_cast<double>(samples.size())), 0.12 + 0.7 * noise)
          << scan.name;
      for (const Point& p : scan.points) {
        EXPECT_LE(exact.distance(p).upper, kEpsilon) << scan.name;
      }
    }
  }
}

// Greedy projection leaves a border here that is none, and no crack that can be told.
TEST(ReferenceFit, ComparesBordersWithThoseOfTheOtherSurface) {
  for (const std::string_view shape : {"box", "slots"}) {
    const ScanOfShape scan =
        scan_of_shape({.shape = shape, .density = Density::kGraded, .holes = true});
    EXPECT_EQ(topology_of(reference_of(scan).bound.reference.view()),
              topology_of(scan.surface.view()))
        << scan.name;
  }
}

// A hole of a plate, wider than a crack, which the tolerance cannot tell from the plate.
TEST(ReferenceFit, FlatHolesAreClosedWithFeaturesAlone) {
  std::vector<Point> plate = sheet(81, 0).vertices;
  std::erase_if(plate, [](const Point& p) { return p.cwiseAbs().maxCoeff() < 0.11; });
  constexpr double kWide = 0.15;
  const auto borders = [&](const char* features, std::optional<double> reach = {}) {
    OptimizeSettings settings = settings_for(kFitMethod);
    settings.epsilon_back = kWide;
    settings.features = features;
    settings.hole_reach = reach;
    ErrorConstraint constraint(plate, kWide, 0);
    ReferenceFit fit;
    const DecimationBound bound = decimation_bound(plate, constraint, settings, &fit);
    EXPECT_EQ(fit.on_planes ? fit.on_planes->on_planes : 0,
              2 - topology_of(bound.reference.view()).border_loops);
    return topology_of(bound.reference.view()).border_loops;
  };
  EXPECT_EQ(borders(kNoFeatures), 2u);
  EXPECT_EQ(borders(kAutoFeatures), 1u);
  EXPECT_EQ(borders(kOnPlanes), 1u);
  EXPECT_EQ(borders(kOnPlanes, 0), 2u);
}

TEST(ReferenceFit, TakesTheInterpolatingMethodForACleanScanAtOnce) {
  const Made made = reference_of(scan_of_shape({.shape = "torus"}));
  ASSERT_EQ(made.fit.tried.size(), 1u);
  EXPECT_EQ(made.fit.best().chain.method, "gp3");
  EXPECT_EQ(made.fit.best().within_half, 1);
}

TEST(ReferenceFit, InterpolatesACleanScanWithABorder) {
  const Made made = reference_of(scan_of_shape({.shape = "sheet"}));
  EXPECT_EQ(made.fit.best().chain.method, "gp3");
}

TEST(ReferenceFit, SmoothsANoisyScan) {
  const Made made = reference_of(scan_of_shape({.shape = "torus", .noise = kEpsilon / 2}));
  EXPECT_EQ(made.fit.best().chain.method, "imls");
}

TEST(ReferenceFit, IsMadeOfAPartOfManyPointsWhereThatIsEnough) {
  const ScanOfShape scan = scan_of_shape({.shape = "torus"});
  const std::size_t points = scan.points.size();
  OptimizeSettings settings = settings_for(kFitMethod);
  settings.reference_points = points / 4;
  const ReferenceFit part = fit_reference(scan.points, 4 * kEpsilon, settings);
  EXPECT_LT(part.made_of, points / 2);
  EXPECT_GT(part.made_of, points / 8);
  EXPECT_EQ(part.best().points, points);
  EXPECT_EQ(topology_of(part.surface.mesh.view()), topology_of(scan.surface.view()));
  EXPECT_GT(part.best().within_half, 0.99);
  EXPECT_EQ(fit_reference(scan.points, kEpsilon / 100, settings).made_of, points);
}

TEST(ReferenceFit, TakesTheMethodThatIsNamed) {
  const ScanOfShape scan = scan_of_shape({.shape = "sphere"});
  for (const char* method : {"gp3", "poisson", "imls"}) {
    EXPECT_EQ(reference_of(scan, method).fit.best().chain.method, method);
  }
}

// Also where another fits as well, or better.
TEST(ReferenceFit, IsMadeByTheMethodThatIsNamedForIt) {
  const ScanOfShape scan = scan_of_shape({.shape = "box"});
  ErrorConstraint constraint(scan.points, kEpsilon, 0);
  for (const char* const method : {"gp3", "imls", "shapes"}) {
    OptimizeSettings settings = settings_for(kFitMethod);
    settings.reference_method = method;
    const ReferenceFit fit = fit_reference(scan.points, kEpsilon, settings);
    ASSERT_EQ(fit.tried.size(), 1u) << method;
    EXPECT_EQ(fit.best().chain.method, method);
  }
}

TEST(ReferenceFit, ASearchBeginsWithTheValuesThatFitTheScan) {
  const ScanOfShape scan = scan_of_shape({.shape = "torus", .noise = kEpsilon / 2});
  OptimizeSettings settings = settings_for("imls");
  settings.fitted = fit_reference(scan.points, kEpsilon, settings).fitted_values();
  ASSERT_GT(settings.fitted.at(Imls::kLeastReach), 0);
  settings.config = default_config(chain_parameters("imls", "bounded"));
  const auto first_reach = [&] {
    const Problem problem = search_problem(settings);
    return chain_of(settings, problem, problem.starts.front()).parameters.at(Imls::kLeastReach);
  };
  EXPECT_EQ(first_reach(), settings.fitted.at(Imls::kLeastReach));
  // A person's own stays.
  const auto gene =
      std::ranges::find(settings.config.genes, Imls::kLeastReach.name, &Parameter::name);
  gene->standard = 1.25;
  EXPECT_EQ(first_reach(), 1.25);
}

TEST(ReferenceFit, LeavesOutliersOut) {
  const ScanOfShape scan = scan_of_shape({.shape = "torus", .noise = 0.1, .outliers = 0.005});
  const Made made = reference_of(scan);
  EXPECT_EQ(topology_of(made.bound.reference.view()), topology_of(scan.surface.view()));
  const std::size_t first = scan.points.size() - scan.outliers;
  std::size_t of_outliers = 0;
  for (const std::uint32_t p : made.bound.outliers) of_outliers += p >= first ? 1 : 0;
  // The others lie near the surface.
  EXPECT_GT(of_outliers, scan.outliers * 8 / 10);
}

TEST(ReferenceFit, IsTheSameForAnyNumberOfJobs) {
  const ScanOfShape scan = scan_of_shape({.shape = "box", .noise = 0.05});
  OptimizeSettings settings = settings_for(kFitMethod);
  const ReferenceFit two = fit_reference(scan.points, kEpsilon, settings);
  settings.jobs = 1;
  const ReferenceFit one = fit_reference(scan.points, kEpsilon, settings);
  EXPECT_TRUE(same_bytes(one.surface.mesh, two.surface.mesh));
  EXPECT_EQ(one.tried.size(), two.tried.size());
  EXPECT_EQ(one.best().chain.method, two.best().chain.method);
}

TEST(ReferenceFit, CountsAgainstASurfaceWhatIsWrongWithIt) {
  TriedSurface good, cracked, bordered, rough, far;
  for (TriedSurface* tried : {&good, &cracked, &bordered, &rough, &far}) {
    tried->chain.method = Gp3::kName;
  }
  good.points = cracked.points = bordered.points = rough.points = far.points = 1000;
  bordered.excess = 1;
  cracked.cracks = 1;
  rough.roughness = 0.3;
  far.joined = 0.1;
  EXPECT_EQ(good.cost(), 0);
  for (const TriedSurface& other : {cracked, bordered, rough, far})
    EXPECT_GT(other.cost(), good.cost());
  // What rounds edges and borders is worth it where the noise is not small.
  TriedSurface rounded = good;
  rounded.chain.method = "imls";
  EXPECT_GT(rounded.cost(), good.cost());
  EXPECT_LT(rounded.cost(), rough.cost());
}

}  // namespace
}  // namespace emax::test
