#include "sw_model/certify/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "tests/support/long_double_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

struct Mesh {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;
  MeshView view() const { return {vertices, triangles}; }
};

double largest_coordinate(MeshView mesh) {
  double largest = 0;
  for (const Point& p : mesh.vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

// The least distance over all triangles, in long double.
double brute_force(const Point& p, MeshView reference) {
  long double least = INFINITY;
  for (std::size_t t = 0; t < reference.triangles.size(); ++t) {
    least = std::min(least, test::long_double_distance(p, reference.corners(t)));
  }
  return static_cast<double>(least);
}

// The greatest distance from a grid of points on every triangle.
double greatest_sample(MeshView mesh, const ExactMesh& reference) {
  constexpr int kSteps = 5;
  double greatest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto v = mesh.corners(t);
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Point p = (i * v[0] + j * v[1] + (kSteps - i - j) * v[2]) / kSteps;
        greatest = std::max(greatest, reference.distance(p).lower);
      }
    }
  }
  return greatest;
}

// What an interval owes; empty where it keeps it.
std::string complaint(MeshView mesh, MeshView reference, const SurfaceDistance& found,
                      double relative) {
  const double rounding = 1e-13 * (largest_coordinate(mesh) + largest_coordinate(reference));
  const double sample = greatest_sample(mesh, ExactMesh(reference));
  const auto say = [](const char* what, double a, double b) {
    return std::string(what) + ": " + std::to_string(a) + " against " + std::to_string(b);
  };
  if (sample > found.upper + rounding) return say("a sample is farther", sample, found.upper);
  const double witness = brute_force(found.witness, reference);
  if (!(witness >= found.lower - rounding)) {
    return say("the witness is nearer", witness, found.lower);
  }
  if (!(brute_force(found.witness, {mesh.vertices, mesh.triangles.subspan(found.triangle, 1)}) <=
        rounding)) {
    return "the witness is not on its triangle";
  }
  if (!(found.upper <=
        found.lower * (1 + relative) + 100 * rounding + 2e-9 * largest_coordinate(mesh))) {
    return say("the interval is wide", found.lower, found.upper);
  }
  return found.lower <= found.upper ? "" : "the ends are in disorder";
}

// The same mesh with its vertices moved by up to `share` of its extent.
Mesh shaken(const test::Stimulus& s, double share, std::uint64_t seed) {
  test::Random random(seed);
  Point low = s.vertices[0], high = low;
  for (const Point& v : s.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const double amount = share * (high - low).maxCoeff();
  Mesh mesh = {s.vertices, s.triangles};
  for (Point& v : mesh.vertices) v += amount * random.point(-1, 1);
  return mesh;
}

TEST(SurfaceDistance, HoldsEverySampleAndItsWitnessForAllStimuli) {
  for (const test::Stimulus& s : test::all_stimuli(201)) {
    for (const double share : {0.001, 0.03}) {
      SCOPED_TRACE(s.name + ", seed 201, shaken by " + std::to_string(share));
      const Mesh other = shaken(s, share, 202);
      const auto found = surface_distance(s.mesh(), ExactMesh(other.view()));
      EXPECT_EQ(complaint(s.mesh(), other.view(), found, 0.01), "");
      const auto back = surface_distance(other.view(), ExactMesh(s.mesh()));
      EXPECT_EQ(complaint(other.view(), s.mesh(), back, 0.01), "");
    }
  }
}

TEST(SurfaceDistance, HoldsForACloudAsReference) {
  for (const test::Stimulus& s : test::all_stimuli(203)) {
    SCOPED_TRACE(s.name + ", seed 203");
    const auto points = triangles_of_points(s.cloud.size());
    const MeshView cloud = {s.cloud, points};
    const auto found = surface_distance(s.mesh(), ExactMesh(cloud), {.relative = 0.001});
    EXPECT_EQ(complaint(s.mesh(), cloud, found, 0.001), "");
  }
}

TEST(SurfaceDistance, BoundsACoarseMeshOfAFineSurface) {
  const test::Stimulus coarse = test::bumpy_sphere(6, 8, 0, 204);
  const test::Stimulus fine = test::bumpy_sphere(24, 36, 0, 204);
  for (const double relative : {0.1, 0.01, 1e-4, 0.0}) {
    SCOPED_TRACE(relative);
    const auto found =
        surface_distance(coarse.mesh(), ExactMesh(fine.mesh()), {.relative = relative});
    EXPECT_EQ(complaint(coarse.mesh(), fine.mesh(), found, relative), "");
    const auto back =
        surface_distance(fine.mesh(), ExactMesh(coarse.mesh()), {.relative = relative});
    EXPECT_EQ(complaint(fine.mesh(), coarse.mesh(), back, relative), "");
  }
}

// Two planes that meet in the y axis, z = |x|.
Mesh valley() {
  return {{{-9, -9, 9}, {-9, 9, 9}, {0, -9, 0}, {0, 9, 0}, {9, -9, 9}, {9, 9, 9}},
          {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}}};
}

// Across it at the height of 2: all corners are nearer than the ridge of equal distance at x = 0.
Mesh bridge() { return {{{-1, -1, 2}, {1, -1, 2}, {-1, 1, 2}, {1, 1, 2}}, {{0, 1, 2}, {1, 3, 2}}}; }

TEST(SurfaceDistance, FindsTheMaximumInsideATriangle) {
  const Mesh mesh = bridge(), reference = valley();
  const auto found = surface_distance(mesh.view(), ExactMesh(reference.view()), {.relative = 1e-9});
  EXPECT_NEAR(found.upper, std::sqrt(2), 1e-8);
  EXPECT_LE(found.lower, std::sqrt(2));
  EXPECT_GE(found.upper, std::sqrt(2));
  EXPECT_NEAR(found.witness.x(), 0, 1e-8);
}

TEST(SurfaceDistance, FindsTheCentreOfThreePoints) {
  const double height = std::sqrt(3) / 2;
  const Mesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}}, {{0, 1, 2}}};
  const Mesh corners = {mesh.vertices, triangles_of_points(3)};
  const auto found = surface_distance(mesh.view(), ExactMesh(corners.view()), {.relative = 1e-6});
  EXPECT_NEAR(found.lower, 1 / std::sqrt(3), 1e-6);
  EXPECT_NEAR(found.upper, 1 / std::sqrt(3), 1e-6);
  EXPECT_LT((found.witness - Point(0.5, height / 3, 0)).norm(), 1e-5);
}

// A square of n x n cells; the diagonals alternate.
Mesh square(std::uint32_t n, double tilt) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      mesh.vertices.push_back({double(i) / n, double(j) / n, tilt * double(i) / n});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, d}, {a, d, b}});
      }
    }
  }
  return mesh;
}

TEST(SurfaceDistance, EndsOnAMeshThatLiesInTheReference) {
  const Mesh coarse = square(3, 0.3), fine = square(8, 0.3);
  for (const double absolute : {1e-3, 1e-6, 0.0}) {
    const SurfaceDistanceOptions options = {.relative = 0, .absolute = absolute};
    const auto there = surface_distance(coarse.view(), ExactMesh(fine.view()), options);
    const auto back = surface_distance(fine.view(), ExactMesh(coarse.view()), options);
    EXPECT_LE(there.upper, std::max(absolute, 1e-9));
    EXPECT_LE(back.upper, std::max(absolute, 1e-9));
    EXPECT_LT(there.cuts, 100000u);
    EXPECT_LT(back.cuts, 100000u);
  }
  const auto same = surface_distance(fine.view(), ExactMesh(fine.view()));
  EXPECT_EQ(same.upper, 0);
  EXPECT_EQ(same.cuts, 0u);
}

// Plain distances to slivers are wrong by any amount, and mislead the choice of candidates.
TEST(SurfaceDistance, SliversOfTheReferenceChangeNothing) {
  const test::Stimulus coarse = test::bumpy_sphere(10, 14, 0, 206);
  test::Stimulus fine = test::bumpy_sphere(24, 36, 0, 206);
  const auto without = surface_distance(coarse.mesh(), ExactMesh(fine.mesh()), {.relative = 1e-4});
  const std::vector<Triangle> triangles = fine.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    const Point along = fine.vertices[a] + 0.3 * (fine.vertices[b] - fine.vertices[a]);
    const double height = t % 3 == 0 ? 0 : t % 3 == 1 ? 1e-16 : 1e-12;
    fine.vertices.push_back(along + height * (fine.vertices[c] - along));
    fine.triangles.push_back({a, b, static_cast<std::uint32_t>(fine.vertices.size() - 1)});
  }
  const ExactMesh reference(fine.mesh());
  const auto with = surface_distance(coarse.mesh(), reference, {.relative = 1e-4});
  EXPECT_LE(with.lower, without.upper);
  EXPECT_GE(with.upper, without.lower);
  EXPECT_LT(with.cuts, 2 * without.cuts + 100);
  const double limit = 1.001 * without.upper;
  EXPECT_TRUE(decided_distance(coarse.mesh(), reference, limit).within(limit));
}

TEST(SurfaceDistance, DecidesWithAViolatingPointAndLessWork) {
  const test::Stimulus coarse = test::bumpy_sphere(10, 14, 0, 205);
  const test::Stimulus fine = test::bumpy_sphere(24, 36, 0, 205);
  const ExactMesh reference(fine.mesh());
  const auto measured = surface_distance(coarse.mesh(), reference, {.relative = 1e-6});
  for (const double factor : {0.3, 0.9, 0.99, 0.9999}) {
    const double limit = factor * measured.lower;
    const auto decided =
        surface_distance(coarse.mesh(), reference, {.relative = 1e-6, .limit = limit});
    EXPECT_FALSE(decided.within(limit)) << factor;
    EXPECT_GT(decided.lower, limit) << factor;
    EXPECT_GT(brute_force(decided.witness, fine.mesh()), limit) << factor;
    EXPECT_LE(decided.cuts, measured.cuts) << factor;
  }
  for (const double factor : {1.0001, 1.01, 2.0}) {
    const double limit = factor * measured.upper;
    const auto decided =
        surface_distance(coarse.mesh(), reference, {.relative = 1e-6, .limit = limit});
    EXPECT_TRUE(decided.within(limit)) << factor;
    EXPECT_GE(decided.upper, measured.lower) << factor;
    EXPECT_LE(decided.cuts, measured.cuts) << factor;
  }
  EXPECT_LT(surface_distance(coarse.mesh(), reference, {.limit = 2 * measured.upper}).cuts,
            measured.cuts / 2);
}

TEST(SurfaceDistanceFault, ChecksCatchABoundFromEachCornersOwnNearestTriangle) {
  const Mesh mesh = bridge(), reference = valley();
  const DeliberateFault fault(Fault::kNearestOfEachCorner);
  const auto wrong = surface_distance(mesh.view(), ExactMesh(reference.view()));
  EXPECT_NE(complaint(mesh.view(), reference.view(), wrong, 0.01), "");
}

TEST(SurfaceDistanceFault, ChecksCatchASearchThatStopsTooEarly) {
  const test::Stimulus coarse = test::bumpy_sphere(6, 8, 0, 204);
  const test::Stimulus fine = test::bumpy_sphere(24, 36, 0, 204);
  const DeliberateFault fault(Fault::kStopsEarly);
  const auto wrong = surface_distance(coarse.mesh(), ExactMesh(fine.mesh()));
  EXPECT_NE(complaint(coarse.mesh(), fine.mesh(), wrong, 0.01), "");
}

// Far from the origin a cut moves by more than the distance is rounded by. A segment between two
// points of the reference, whose maximum is known: where both are equally far.
TEST(SurfaceDistanceFault, ChecksCatchAMissingMarginForTheRoundingOfCuts) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  test::Random random(206);
  int caught = 0;
  for (int i = 0; i < 200; ++i) {
    const Point origin = 1e7 * random.point(-1, 1);
    const Mesh mesh = {{origin + random.point(-1, 1), origin + random.point(-1, 1)}, {{0, 1, 1}}};
    const Mesh points = {{mesh.vertices[0] + 0.1 * random.point(-1, 1),
                          mesh.vertices[1] + 0.1 * random.point(-1, 1)},
                         triangles_of_points(2)};
    const Vector a = mesh.vertices[0].cast<long double>();
    const Vector along = mesh.vertices[1].cast<long double>() - a;
    const Vector p = points.vertices[0].cast<long double>() - a;
    const Vector q = points.vertices[1].cast<long double>() - a;
    const long double s = (q.squaredNorm() - p.squaredNorm()) / (2 * along.dot(q - p));
    if (!(s > 0.1L && s < 0.9L)) continue;
    const long double exact =
        std::max({(s * along - p).norm(), p.norm(), (along - q).norm()});  // of the nearest points

    SurfaceDistanceOptions options;
    options.relative = 0;
    const auto found = surface_distance(mesh.view(), ExactMesh(points.view()), options);
    EXPECT_GE(found.upper, exact) << "case " << i;
    EXPECT_LE(found.lower, exact) << "case " << i;
    EXPECT_LE(found.upper - found.lower, 1e-5) << "case " << i;
    const DeliberateFault fault(Fault::kCutsWithoutMargin);
    const auto wrong = surface_distance(mesh.view(), ExactMesh(points.view()), options);
    caught += wrong.upper < exact || wrong.lower > exact ? 1 : 0;
  }
  EXPECT_GT(caught, 10);
}

TEST(SurfaceDistance, IsTheSameAtEveryScale) {
  const test::Stimulus s = test::bumpy_sphere(6, 8, 0, 209);
  const Mesh other = shaken(s, 0.05, 210);
  const auto found = surface_distance(s.mesh(), ExactMesh(other.view()));
  for (const double scale : {0x1p-400, 0x1p-100, 0x1p100, 0x1p400}) {
    Mesh scaled = {s.vertices, s.triangles}, reference = other;
    for (Point& p : scaled.vertices) p *= scale;
    for (Point& p : reference.vertices) p *= scale;
    const auto there = surface_distance(scaled.view(), ExactMesh(reference.view()));
    EXPECT_DOUBLE_EQ(there.upper, found.upper * scale);
    EXPECT_DOUBLE_EQ(there.lower, found.lower * scale);
    EXPECT_EQ(there.cuts, found.cuts);
  }
}

TEST(SurfaceDistance, RefusesWhatItCannotMeasure) {
  const test::Stimulus s = test::bumpy_sphere(4, 5, 0, 207);
  const ExactMesh reference(s.mesh());
  EXPECT_THROW(surface_distance({s.vertices, {}}, reference), Error);
  EXPECT_THROW(surface_distance({{}, s.triangles}, reference), std::invalid_argument);
  for (const double bad : {double(INFINITY), double(NAN), 1e151}) {
    Mesh mesh = {s.vertices, s.triangles};
    mesh.vertices[mesh.triangles[2][1]].y() = bad;
    EXPECT_THROW(surface_distance(mesh.view(), reference), Error) << bad;
  }
  {
    const ScopedFlushMode flush;
    EXPECT_THROW(surface_distance(s.mesh(), reference), std::logic_error);
  }
}

TEST(SurfaceDistance, EndsWhenPolled) {
  const test::Stimulus coarse = test::bumpy_sphere(10, 14, 0, 208);
  const test::Stimulus fine = test::bumpy_sphere(40, 60, 0, 208);
  struct Enough {};
  int polls = 0;
  SurfaceDistanceOptions options;
  options.poll = [&polls] {
    if (++polls == 2) throw Enough{};
  };
  EXPECT_THROW(surface_distance(fine.mesh(), ExactMesh(coarse.mesh()), options), Enough);
}

}  // namespace
}  // namespace emax
