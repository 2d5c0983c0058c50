#include "host/chain/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include "host/decimate/bounded_decimation.h"
#include "host/decimate/far_points.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/parameters/descriptions.h"
#include "host/surface/manifold_part.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surface_clouds.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

ChainSettings settings(const std::string& method) {
  ChainSettings result{method, "schroeder", ParameterValues(chain_parameters(method, "schroeder"))};
  if (method == "hoppe") result.parameters.set(Hoppe::kResolution, 32);
  return result;
}

TEST(ChainParameters, JoinTheStagesWithStandardsInTheirDomains) {
  for (const MethodDescription& method : reconstruction_methods()) {
    for (const DecimatorDescription& decimator : decimators()) {
      const auto chain = chain_parameters(method.name, decimator.name);
      std::set<std::string> names;
      for (const Parameter& spec : chain) {
        EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
        EXPECT_LT(spec.lower, spec.upper) << spec.name;
        EXPECT_LE(spec.lower, spec.standard) << spec.name;
        EXPECT_LE(spec.standard, spec.upper) << spec.name;
        EXPECT_FALSE(spec.meaning.empty()) << spec.name;
      }
      EXPECT_EQ(chain.size(), method.parameters.size() + 1 + decimator.parameters.size());
      EXPECT_TRUE(names.contains("fill.size"));
    }
  }
  EXPECT_THROW(chain_parameters("gp3", "quadric"), Error);
  EXPECT_THROW(chain_parameters("alpha", "schroeder"), Error);
}

TEST(RunChain, MakesASmallerMesh) {
  const std::vector<Point> cloud = torus_cloud(60, 24);
  for (const std::string method : {"gp3", "hoppe"}) {
    const ChainResult result = Chain(cloud).run(settings(method));
    EXPECT_LT(result.mesh.triangles.size(), result.reconstruction_triangles / 2) << method;
    EXPECT_GT(result.mesh.triangles.size(), 100u) << method;
    EXPECT_EQ(check_mesh(result.mesh.view()).inconsistent_edges, 0u) << method;
  }
}

ChainSettings bounded(double mu = 2.3) {
  ChainSettings result{"gp3", "bounded", ParameterValues(chain_parameters("gp3", "bounded"))};
  result.parameters.set(Gp3::kMu, mu);
  return result;
}

DecimationBound two_sided_bound(const std::vector<Point>& cloud, double epsilon, double back) {
  ChainSettings standards = bounded();
  standards.decimator = kNoDecimator;
  const TriangleMesh surface = Chain(cloud).run(standards).mesh;
  return {epsilon, back, reference_surface(surface, cloud, epsilon / 2).mesh, {}};
}

TEST(RunChain, BoundedDecimationIsHeldToTheReference) {
  const std::vector<Point> cloud = torus_cloud(60, 24);
  const DecimationBound bound = two_sided_bound(cloud, 0.05, 0.06);
  EXPECT_TRUE(check_mesh(bound.reference.view()).valid());
  EXPECT_TRUE(certify(cloud, bound.reference.view()).within(0.025));
  ChainSettings candidate = bounded(3);
  candidate.parameters.set(Bounded::kFlatness, 0.01);
  const ChainResult result = Chain(cloud, bound).run(candidate);
  EXPECT_LT(result.mesh.triangles.size(), result.reconstruction_triangles / 4);
  EXPECT_TRUE(check_mesh(result.mesh.view()).valid());
  EXPECT_TRUE(certify(cloud, result.mesh.view()).within(0.05));
  const SurfaceDistance back =
      surface_distance(result.mesh.view(), ExactMesh(bound.reference.view()));
  EXPECT_LE(back.lower, result.back_distance);
  EXPECT_LE(result.back_distance, 0.06);

  DecimationBound one_sided = {0.05, 0, {}, {}};
  const ChainResult freer = Chain(cloud, one_sided).run(candidate);
  EXPECT_LE(freer.mesh.triangles.size(), result.mesh.triangles.size());
  EXPECT_EQ(freer.back_distance, 0);
  EXPECT_EQ(freer.reference_distance, 0);
}

// A surface that is not the reference's is handed back as it is, with what it breaks.
TEST(RunChain, WhatIsNotTheReferenceIsNotDecimated) {
  const std::vector<Point> cloud = torus_cloud(60, 24);
  DecimationBound bound = two_sided_bound(cloud, 0.05, 0.05);
  EXPECT_EQ(Chain(cloud, bound).run(bounded()).topology_difference, 0u);
  TriangleMesh part = bound.reference;
  std::erase_if(part.triangles, [&](const Triangle& t) { return part.vertices[t[0]].x() > 0; });
  bound.reference = manifold_part(part).mesh;
  const ChainResult result = Chain(cloud, bound).run(bounded());
  // Half a torus: no handle and two borders instead of a handle.
  EXPECT_EQ(result.topology_difference, 3u);
  EXPECT_GT(result.back_distance, 0.5);
  EXPECT_LE(result.reference_distance, 0.05);
  EXPECT_GE(result.mesh.triangles.size(), result.reconstruction_triangles / 2);
  EXPECT_TRUE(check_mesh(result.mesh.view()).valid());

  for (Point& p : bound.reference.vertices) p += Point(0, 0, 10);
  EXPECT_GT(Chain(cloud, bound).run(bounded()).reference_distance, 5);
}

// The twin of the decision: a distance measured without a limit.
TEST(BoundedStage, TellsHowFarAMeshStraysFromTheReference) {
  const std::vector<Point> cloud = torus_cloud(60, 24);
  const DecimationBound bound = two_sided_bound(cloud, 0.05, 0.05);
  const BoundedStage stage(cloud, bound);
  const ExactMesh reference(bound.reference.view());
  for (const double shift : {0.0, 0.03, 0.0499, 0.0501, 0.06, 2.0}) {
    TriangleMesh mesh = bound.reference;
    for (Point& p : mesh.vertices) p += Point(0, 0, shift);
    SurfaceDistanceOptions exactly;
    exactly.relative = 1e-4;  // less than lies between the shifts and the bound
    const SurfaceDistance measured = surface_distance(mesh.view(), reference, exactly);
    const double back = stage.judge(mesh).back_distance;
    EXPECT_EQ(back <= 0.05, measured.upper <= 0.05) << shift;
    EXPECT_GE(back, 0.9 * measured.lower) << shift;
    EXPECT_LE(back, std::max(measured.upper, 0.05)) << shift;
  }
}

// The deliberate fault that this direction alone catches: a mesh with a hole in it lies in the
// reference, with a hole between the points it keeps all of them.
TEST(BoundedStage, TellsHowFarTheReferenceIsFromAMesh) {
  const std::vector<Point> corners = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
  const DecimationBound bound = {0.5, 0.5, {corners, {{0, 1, 2}, {0, 2, 3}}}, {}};
  const BoundedStage stage(corners, bound);
  EXPECT_LE(stage.judge(bound.reference).reference_distance, 0.5);
  // A frame of the given width around the square's inside.
  const auto frame = [&](double width) {
    TriangleMesh mesh{corners, {}};
    for (const Point& p : corners)
      mesh.vertices.push_back(p + width * Point(p.x() > 0 ? -1 : 1, p.y() > 0 ? -1 : 1, 0));
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      mesh.triangles.push_back({i, j, 4 + j});
      mesh.triangles.push_back({i, 4 + j, 4 + i});
    }
    return mesh;
  };
  for (const double width : {3.45, 3.499, 3.501, 3.6, 3.9}) {
    const TriangleMesh mesh = frame(width);
    EXPECT_TRUE(certify(corners, mesh.view()).within(0));
    EXPECT_LE(stage.judge(mesh).back_distance, 1e-6);
    const SurfaceDistance measured =
        surface_distance(bound.reference.view(), ExactMesh(mesh.view()));
    EXPECT_NEAR(measured.upper, 4 - width, 0.01);
    const double found = stage.judge(mesh).reference_distance;
    EXPECT_EQ(found <= 0.5, width > 3.5) << width;
    EXPECT_GE(found, 0.9 * measured.lower) << width;
    EXPECT_LE(found, std::max(measured.upper, 0.5)) << width;
  }
  EXPECT_EQ(BoundedStage(corners, {0.5, 0, {}, {}}).judge(frame(1)).reference_distance, 0);
}

// Triangles over a sheet: within half of epsilon, within it, and beyond.
TEST(BoundedStage, DropsPiecesThatNoPointNeeds) {
  TriangleMesh surface = sheet(16, 0);
  for (const double height : {0.04, 0.08, 0.2}) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.insert(surface.vertices.end(), {{0, 5 * height - 0.5, height},
                                                     {0.1, 5 * height - 0.5, height},
                                                     {0, 5 * height - 0.4, height}});
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  const auto components = [](const TriangleMesh& mesh) {
    return check_mesh(mesh.view()).components;
  };
  DecimationBound bound;
  EXPECT_EQ(components(BoundedStage(surface.vertices, bound).without_needless(surface)), 4u);
  bound.epsilon = 0.1;
  const BoundedStage stage(surface.vertices, bound);
  const TriangleMesh start = stage.without_needless(surface);
  EXPECT_EQ(components(start), 3u);
  const ParameterValues standards(Bounded::parameters());
  const TriangleMesh mesh = Bounded::run(start, standards, stage, {}).mesh;
  EXPECT_EQ(components(mesh), 2u);
  EXPECT_LE(certify(surface.vertices, mesh.view()).e_max_upper, bound.epsilon);
}

// A ball and its cavity: the reconstruction turns both outward, the chain the inner one inward.
TEST(RunChain, ClosedComponentsBoundASolid) {
  std::vector<Point> cloud = sphere_cloud(2000);
  for (const Point& p : sphere_cloud(600)) cloud.push_back(0.4 * p);
  ChainSettings standards = bounded();
  standards.decimator = kNoDecimator;
  const TriangleMesh mesh = Chain(cloud).run(standards).mesh;
  EXPECT_EQ(topology_of(mesh.view()), (MeshTopology{2, 0, 0}));
  EXPECT_NEAR(signed_volume(mesh), 4 * std::numbers::pi / 3 * (1 - 0.064), 0.1);
}

TEST(RunChain, OutliersDoNotHoldTheDecimatorBack) {
  std::vector<Point> cloud = torus_cloud(60, 24);
  const std::size_t sound = cloud.size();
  for (int i = 0; i < 5; ++i) cloud.push_back(Point(0.3 * i - 0.6, 0.1, 5));
  DecimationBound bound = {0.05, 0, {}, {}};
  for (std::size_t i = sound; i < cloud.size(); ++i) {
    bound.outliers.push_back(static_cast<std::uint32_t>(i));
  }
  const TriangleMesh mesh = Chain(cloud, bound).run(bounded()).mesh;
  EXPECT_TRUE(certify(cloud, mesh.view(), bound.outliers).within(0.05));
  EXPECT_FALSE(certify(cloud, mesh.view()).within(1));
}

// A method that is not searched makes the reference, where there is one.
TEST(ChainParameters, CandidatesOfAMethodThatIsNotSearchedTakeTheReference) {
  EXPECT_EQ(method_for("shapes", "bounded"), kFitMethod);
  EXPECT_EQ(method_for("shapes", "schroeder"), "shapes");
  EXPECT_EQ(method_for("imls", "bounded"), "imls");
  EXPECT_EQ(method_for(kFitMethod, "schroeder"), "gp3");
}

// Every candidate of auto is one of a searched method, with the values that mean something there.
TEST(ChainParameters, AutoHoldsEverySearchedMethod) {
  const auto all = chain_parameters("auto", "bounded");
  const ParameterValues standards(all);
  std::set<std::string> names;
  for (const Parameter& spec : all) EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
  for (std::size_t m = 0; m < searched_methods().size(); ++m) {
    const std::string method = searched_methods()[m].name;
    ParameterValues values = standards;
    values.by_name()["method"] = static_cast<double>(m);
    ChainSettings candidate = chain_settings("auto", "bounded", values);
    EXPECT_EQ(candidate.method, method);
    for (const Parameter& spec : chain_parameters(method, "bounded")) {
      EXPECT_TRUE(names.contains(spec.name)) << spec.name;
      EXPECT_TRUE(candidate.parameters.by_name().erase(spec.name)) << spec.name;
    }
    EXPECT_EQ(candidate.parameters.by_name(),
              (ParameterValues::ByName{{"mls.method", 0}, {"fill.method", 1}}));
  }
  ParameterValues unfilled = standards;
  unfilled.set(Fill::kMethod, Fill::Method::kNone);
  unfilled.set(Mls::kMethod, Mls::Method::kSmooth);
  const ChainSettings candidate = chain_settings("auto", "bounded", unfilled);
  EXPECT_FALSE(candidate.parameters.contains(Fill::kSize));
  EXPECT_FALSE(candidate.parameters.contains(Mls::kCell));
  EXPECT_TRUE(candidate.parameters.contains(Mls::kRadius));
  EXPECT_EQ(chain_settings("gp3", "bounded", standards).parameters, standards);
}

// A run without features has no gene for them; a candidate without planes no thresholds.
TEST(ChainParameters, PlanesAreGenesWhereTheyAreAskedFor) {
  const Parameters none = chain_parameters(kFitMethod, "bounded");
  EXPECT_EQ(chain_parameters(kFitMethod, "bounded", kNoFeatures), none);
  const Parameters always = chain_parameters(kFitMethod, "bounded", kOnPlanes);
  ASSERT_EQ(always.size(), none.size() + 4);
  EXPECT_EQ(always[none.size()].fixed, 1);
  const Parameters free = chain_parameters(kAutoMethod, "bounded", kAutoFeatures);
  ASSERT_EQ(free.size(), chain_parameters(kAutoMethod, "bounded").size() + 4);
  EXPECT_FALSE(free[free.size() - 4].fixed);
  EXPECT_EQ(free[free.size() - 4].upper, 1);  // curved shapes are no choice of the search
  const Parameters all = chain_parameters(kFitMethod, "bounded", kAllFeatures);
  ASSERT_EQ(all.size(), always.size());
  EXPECT_EQ(all[none.size()].fixed, 2);
  EXPECT_EQ(all.back().fixed, 0);
  EXPECT_EQ(free.back().only_with->gene, free.size() - 4);

  ParameterValues values(free);
  const ChainSettings on_planes = chain_settings(kAutoMethod, "bounded", values);
  EXPECT_EQ(features_key(on_planes).by_name().size(), 3u);
  values.set(PlaneFeatures::kMethod, PlaneFeatures::Method::kNone);
  const ChainSettings without = chain_settings(kAutoMethod, "bounded", values);
  EXPECT_TRUE(features_key(without).by_name().empty());
  EXPECT_EQ(without.parameters,
            chain_settings(kAutoMethod, "bounded",
                           ParameterValues(chain_parameters(kAutoMethod, "bounded")))
                .parameters);
  ChainSettings incomplete = on_planes;
  incomplete.parameters.by_name().erase(std::string(PlaneFeatures::kBand.name));
  EXPECT_THROW(require_values(incomplete), Error);
}

// The reference has a border that no surface of the cloud has.
TEST(RunChain, DecimatesTheReferenceWithTheValuesThatMadeIt) {
  const std::vector<Point> cloud = torus_cloud(60, 24);
  DecimationBound bound = two_sided_bound(cloud, 0.05, 0.06);
  bound.reference.triangles.pop_back();
  EXPECT_GT(Chain(cloud, bound).run(bounded()).topology_difference, 0u);
  bound.made_by = surface_key(bounded());
  const ChainResult made = Chain(cloud, bound).run(bounded());
  EXPECT_EQ(made.topology_difference, 0u);
  EXPECT_LT(made.mesh.triangles.size(), bound.reference.triangles.size() / 2);
  const ChainSettings fit{kFitMethod, "bounded",
                          ParameterValues(chain_parameters(kFitMethod, "bounded"))};
  EXPECT_TRUE(same_bytes(made.mesh, Chain(cloud, bound).run(fit).mesh));
  EXPECT_GT(Chain(cloud, bound).run(bounded(2.4)).topology_difference, 0u);
}

// A noisy cube, as its own reference.
struct NoisyCube {
  static constexpr double kWithin = 0.03, kNoise = 0.006;
  TriangleMesh mesh = cube(14);
  NoisyCube() {
    Random random(named_seed("noisy cube", 1));
    for (Point& v : mesh.vertices) v += random.point(-kNoise, kNoise);
  }
  DecimationBound bound() const { return {kWithin, kWithin, mesh, {}}; }
  static ChainSettings candidate(double band, int least_points) {
    ChainSettings result{kFitMethod, "bounded",
                         ParameterValues(chain_parameters(kFitMethod, "bounded", kOnPlanes))};
    result.parameters.set(PlaneFeatures::kBand, band);
    result.parameters.set(PlaneFeatures::kLeastPoints, least_points);
    return result;
  }
  // The decimator alone on planes of these thresholds.
  TriangleMesh twin(const PlaneThresholds& thresholds) const {
    DecimationSettings settings;
    settings.epsilon = settings.epsilon_back = kWithin;
    settings.planes = std::make_shared<const PlaneParts>(find_plane_parts(
        mesh.vertices, kWithin, 1, [] {}, thresholds));
    return BoundedDecimator(mesh, mesh.vertices).run(settings).mesh;
  }
};

TEST(RunChain, FollowsThePlanesOfTheCandidatesThresholds) {
  const NoisyCube noisy;
  Chain chain(noisy.mesh.vertices, noisy.bound());
  const TriangleMesh standard = chain.run(NoisyCube::candidate(0.5, 100)).mesh;
  EXPECT_EQ(standard.triangles.size(), 12u);
  EXPECT_TRUE(same_bytes(standard, noisy.twin({})));
  const TriangleMesh none = chain.run(NoisyCube::candidate(0.5, 1000)).mesh;
  EXPECT_TRUE(same_bytes(none, noisy.twin({0.5, 1000})));
  EXPECT_FALSE(same_bytes(none, standard));
  EXPECT_TRUE(same_bytes(chain.run(NoisyCube::candidate(0.25, 100)).mesh, noisy.twin({0.25, 100})));
  EXPECT_EQ(chain.planes_found(), 3u);
  EXPECT_TRUE(same_bytes(chain.run(NoisyCube::candidate(0.5, 100)).mesh, standard));
  EXPECT_EQ(chain.planes_found(), 3u);
}

TEST(RunChain, FollowsCurvedShapesWhereTheCandidateDoes) {
  constexpr double kWithin = 0.02;
  const TriangleMesh mesh = can(60, 20);
  const ChainSettings candidate{
      kFitMethod, "bounded",
      ParameterValues(chain_parameters(kFitMethod, "bounded", kAllFeatures))};
  const TriangleMesh made = Chain(mesh.vertices, {kWithin, kWithin, mesh, {}}).run(candidate).mesh;
  for (const Point& v : made.vertices) EXPECT_NEAR(std::hypot(v.x(), v.y()), 1, 1e-6);
}

TEST(RunChainFault, ThatForgetsThresholdsIsSeen) {
  const NoisyCube noisy;
  Chain chain(noisy.mesh.vertices, noisy.bound());
  chain.run(NoisyCube::candidate(0.5, 100));
  const DeliberateFault fault(Fault::kForgetsThresholds);
  chain.run(NoisyCube::candidate(0.5, 100));
  EXPECT_FALSE(
      same_bytes(chain.run(NoisyCube::candidate(0.5, 1000)).mesh, noisy.twin({0.5, 1000})));
}

// A can as its own reference: planes beside a surface on which spreading the error pays.
struct PlanesBesideACurve {
  static constexpr double kWithin = 0.02;
  TriangleMesh mesh = can(60, 20);
  TriangleMesh run(bool spread) const {
    ChainSettings candidate{kFitMethod, "bounded",
                            ParameterValues(chain_parameters(kFitMethod, "bounded", kOnPlanes))};
    candidate.parameters.set(PlaneFeatures::kSpread, spread);
    return Chain(mesh.vertices, {kWithin, kWithin, mesh, {}}).run(candidate).mesh;
  }
  // The decimator alone.
  TriangleMesh twin(bool spread) const {
    DecimationSettings settings;
    settings.epsilon = settings.epsilon_back = kWithin;
    settings.planes =
        std::make_shared<const PlaneParts>(find_plane_parts(mesh.vertices, kWithin, 1));
    settings.spread_on_planes = spread;
    return BoundedDecimator(mesh, mesh.vertices).run(settings).mesh;
  }
};

TEST(RunChain, SpreadsTheErrorOnPlanesWhereTheCandidateDoes) {
  const PlanesBesideACurve beside;
  const TriangleMesh plain = beside.run(false), spread = beside.run(true);
  EXPECT_TRUE(same_bytes(plain, beside.twin(false)));
  EXPECT_TRUE(same_bytes(spread, beside.twin(true)));
  EXPECT_LT(spread.triangles.size(), plain.triangles.size());
}

TEST(RunChainFault, ThatForgetsToSpreadIsSeen) {
  const PlanesBesideACurve beside;
  const DeliberateFault fault(Fault::kForgetsSpread);
  EXPECT_FALSE(same_bytes(beside.run(true), beside.twin(true)));
}

// Beside a method or beside all of them.
TEST(ChainParameters, AutoHoldsBothDecimators) {
  for (const std::string method : {"gp3", "auto"}) {
    const auto all = chain_parameters(method, "auto");
    ParameterValues values(all);
    EXPECT_EQ(values.by_name().size(), all.size());
    for (std::size_t d = 0; d < decimators().size(); ++d) {
      const std::string decimator = decimators()[d].name;
      values.by_name()["decimator"] = static_cast<double>(d);
      const ChainSettings candidate = chain_settings(method, "auto", values);
      EXPECT_EQ(candidate.method, "gp3");
      EXPECT_EQ(candidate.decimator, decimator);
      const ParameterValues plain(chain_parameters(method, decimator));
      EXPECT_EQ(candidate.parameters, chain_settings(method, decimator, plain).parameters);
    }
  }
}

TEST(RunChain, AutoRunsTheMethodsThemselves) {
  const std::vector<Point> cloud = torus_cloud(40, 16);
  ParameterValues values(chain_parameters("auto", "schroeder"));
  values.set(Hoppe::kResolution, 32);
  Chain chain(cloud);
  for (const double m : {0.0, 2.0}) {
    values.by_name()["method"] = m;
    const ChainSettings candidate = chain_settings("auto", "schroeder", values);
    ChainSettings plain{candidate.method, "schroeder", {}};
    for (const Parameter& spec : chain_parameters(plain.method, "schroeder")) {
      plain.parameters.by_name()[spec.name] = values.by_name().at(spec.name);
    }
    EXPECT_TRUE(same_bytes(chain.run(candidate).mesh, Chain(cloud).run(plain).mesh)) << m;
  }
}

// Each way to fill holes and to smooth is another surface, kept under its own key.
TEST(RunChain, TellsTheWaysToFillAndSmoothApart) {
  std::vector<Point> cloud = torus_cloud(40, 16);
  std::erase_if(cloud, [](const Point& p) { return (p - Point(1.4, 0, 0)).norm() < 0.5; });
  Chain chain(cloud);
  ParameterValues values(chain_parameters("auto", kNoDecimator));
  values.set(Fill::kSize, 0.5);
  const auto run = [&] { return chain.run(chain_settings("auto", kNoDecimator, values)).mesh; };
  std::vector<TriangleMesh> meshes;
  for (const Fill::Method fill :
       {Fill::Method::kNone, Fill::Method::kFlat, Fill::Method::kSmooth}) {
    for (const Mls::Method mls :
         {Mls::Method::kNone, Mls::Method::kSmooth, Mls::Method::kResample}) {
      values.set(Fill::kMethod, fill);
      values.set(Mls::kMethod, mls);
      values.set(Mls::kCell, 1.5);
      meshes.push_back(run());
      EXPECT_EQ(check_mesh(meshes.back().view()).boundary_edges > 0, fill == Fill::Method::kNone)
          << static_cast<int>(fill) << static_cast<int>(mls);
    }
  }
  for (std::size_t a = 0; a < meshes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_FALSE(same_bytes(meshes[a], meshes[b])) << a << ' ' << b;
  }
  EXPECT_EQ(chain.reconstructions(), 3u);
  EXPECT_EQ(chain.clouds(), 2u);
  values.by_name().erase("mls.cell");
  EXPECT_THROW(run(), Error);
}

// The twin of the caches is none: every candidate by a chain of its own.
TEST(RunChain, TakesNoNoticeOfTheCaches) {
  const std::vector<Point> cloud = torus_cloud(30, 12);
  const DecimationBound bound = two_sided_bound(cloud, 0.15, 0.15);
  Chain shared(cloud, bound), forgetful(cloud, bound, 1);
  std::set<StageKey> reconstructions;
  Random random(9);
  SCOPED_TRACE("seed 9");
  for (int i = 0; i < 8; ++i) {
    ChainSettings candidate = i % 2 == 0 ? settings("gp3") : bounded();
    candidate.parameters.set(Gp3::kMu, 2 + 0.5 * random.below(3));
    candidate.parameters.set(Fill::kSize, 0.1 * random.below(2));
    candidate.parameters.set(Mls::kMethod, i < 4 ? Mls::Method::kNone : Mls::Method::kSmooth);
    candidate.parameters.set(Mls::kRadius, 2);
    candidate.parameters.set(Mls::kOrder, 2);
    if (i % 2 == 0) candidate.parameters.set(Schroeder::kReduction, random.uniform(0.2, 0.9));
    reconstructions.insert(reconstruction_key(candidate));
    const ChainResult expected = Chain(cloud, bound).run(candidate);
    for (Chain* chain : {&shared, &forgetful}) {
      const ChainResult result = chain->run(candidate);
      EXPECT_TRUE(same_bytes(result.mesh, expected.mesh)) << i;
      EXPECT_EQ(result.reconstruction_triangles, expected.reconstruction_triangles);
      EXPECT_EQ(result.unmeshed_points, expected.unmeshed_points);
      EXPECT_EQ(result.topology_difference, expected.topology_difference);
      EXPECT_EQ(result.back_distance, expected.back_distance);
      EXPECT_EQ(result.reference_distance, expected.reference_distance);
    }
  }
  EXPECT_EQ(shared.clouds(), 1u);
  EXPECT_EQ(shared.reconstructions(), reconstructions.size());
  EXPECT_LT(reconstructions.size(), 8u);
}

TEST(RunChain, RepeatsNoStageForALaterStagesGene) {
  Chain chain(torus_cloud(30, 12), {0.1, 0, {}, {}});
  ChainSettings candidate = bounded();
  EXPECT_GT(chain.run(candidate).seconds.reconstruct, 0);
  candidate.parameters.set(Bounded::kFlatness, 0.01);
  const ChainResult again = chain.run(candidate);
  EXPECT_EQ(again.seconds.reconstruct, 0);
  EXPECT_EQ(again.seconds.prepare, 0);
  EXPECT_EQ(chain.surfaces(), 1u);
  candidate.parameters.set(Fill::kSize, 0.01);
  chain.run(candidate);
  EXPECT_EQ(chain.surfaces(), 2u);
  EXPECT_EQ(chain.reconstructions(), 1u);
  candidate.parameters.set(Gp3::kMu, 3);
  chain.run(candidate);
  EXPECT_EQ(chain.reconstructions(), 2u);
  EXPECT_EQ(chain.clouds(), 0u);
  ChainSettings smoothed = settings("gp3");
  smoothed.parameters.set(Mls::kMethod, Mls::Method::kSmooth);
  smoothed.parameters.set(Mls::kRadius, 4);
  smoothed.parameters.set(Mls::kOrder, 2);
  for (const double mu : {3.0, 4.0}) {
    smoothed.parameters.set(Gp3::kMu, mu);
    chain.run(smoothed);
  }
  EXPECT_EQ(chain.reconstructions(), 4u);
  EXPECT_EQ(chain.clouds(), 1u);
}

struct Sized {
  std::size_t size;
  std::size_t size_in_bytes() const { return size; }
};

TEST(StageCache, KeepsTheLastUsedWithinItsBytes) {
  StageCache<int, Sized> cache(100);
  const auto get = [&](int key, std::size_t size) {
    const std::size_t before = cache.made();
    cache.get(key, [&] { return Sized{size}; });
    return cache.made() > before;
  };
  EXPECT_TRUE(get(1, 40));
  EXPECT_TRUE(get(2, 40));
  EXPECT_FALSE(get(1, 40));
  EXPECT_TRUE(get(3, 40));  // 2, unused for longest, goes
  EXPECT_EQ(cache.bytes(), 80u);
  EXPECT_FALSE(get(1, 40));
  EXPECT_TRUE(get(2, 40));
  EXPECT_TRUE(get(4, 1000));  // one alone may be greater
  EXPECT_EQ(cache.size(), 1u);
  EXPECT_FALSE(get(4, 1000));
  EXPECT_THROW(cache.get(5, []() -> Sized { throw Error("none"); }), Error);
  EXPECT_FALSE(get(4, 1000));
}

TEST(RunChain, NamesAMissingParameter) {
  for (const Parameter& spec : chain_parameters("gp3", "schroeder")) {
    ChainSettings lacking = settings("gp3");
    lacking.parameters.by_name().erase(spec.name);
    try {
      Chain(torus_cloud(20, 12)).run(lacking);
      ADD_FAILURE() << "no error without " << spec.name;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(spec.name), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace emax::test
