#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>

#include "host/emax_search/emax_search.h"
#include "host/emax_search/simd_evaluator.h"
#include "host/geometry/mesh_file.h"
#include "sw_model/error.h"
#include "sw_model/float_bits.h"
#include "tests/benchmarks/cgal_peer.h"
#include "tests/benchmarks/measurement.h"
#include "tests/support/stimuli.h"

namespace emax::benchmarks {
namespace {

constexpr double kDisplacement = 0.002, kCell = 0.012;  // of the cloud's extent
constexpr std::size_t kBruteForcePoints = 256;

// A cloud, a mesh and the trees of both engines.
struct Case {
  Case(std::span<const Point> points, TriangleMesh triangles)
      : cloud(points),
        mesh(std::move(triangles)),
        tree(mesh.view(), cloud.normalization()),
        peer(points, mesh.view()) {
    peer.build();
    std::vector<Point> some;
    for (std::size_t i = 0; i < kBruteForcePoints; ++i) {
      some.push_back(points[i * points.size() / kBruteForcePoints]);
    }
    sample = std::make_unique<PreparedCloud>(some);
    sample_tree = std::make_unique<TriangleTree>(mesh.view(), sample->normalization());
  }

  PreparedCloud cloud;
  TriangleMesh mesh;
  TriangleTree tree;
  CgalPeer peer;
  std::unique_ptr<PreparedCloud> sample;
  std::unique_ptr<TriangleTree> sample_tree;
};

double extent(std::span<const Point> points) {
  Eigen::AlignedBox3d box;
  for (const Point& p : points) box.extend(p);
  return box.diagonal().norm();
}

TriangleMesh displaced(TriangleMesh mesh) {
  test::Random random(83);
  const double most = kDisplacement * extent(mesh.vertices);
  for (Point& p : mesh.vertices) p += most * random.point(-1, 1);
  return mesh;
}

// A coarser mesh: the vertices of a cell of a grid become one of them.
TriangleMesh clustered(const TriangleMesh& mesh) {
  const double cell = kCell * extent(mesh.vertices);
  std::map<std::array<long, 3>, std::uint32_t> first;
  const auto representative = [&](std::uint32_t i) {
    const Point p = mesh.vertices[i] / cell;
    const std::array<long, 3> key = {std::lround(p.x()), std::lround(p.y()), std::lround(p.z())};
    return first.emplace(key, i).first->second;
  };
  TriangleMesh coarse{mesh.vertices, {}};
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t = {representative(a), representative(b), representative(c)};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) coarse.triangles.push_back(t);
  }
  return coarse;
}

double searched(const PreparedCloud& cloud, const TriangleTree& tree) {
  SimdEvaluator evaluator;
  return bits_float(search_emax(cloud, tree, evaluator).squared_bits);
}

// In normalised units, where the cloud's half-extent is in (1/2, 1].
void require_agreement(const Case& c) {
  const double ours = std::sqrt(searched(c.cloud, c.tree));
  const double theirs =
      c.cloud.normalization().length(std::sqrt(c.peer.greatest_squared_distance()));
  if (!(std::abs(ours - theirs) <= 1e-6)) {
    throw Error(fmt::format("e_max differs: {} by the search, {} by CGAL", ours, theirs));
  }
}

template <class Work>
auto repeat(Work work) {
  return [work](benchmark::State& state) {
    for ([[maybe_unused]] const auto _ : state) {
      auto result = work();
      benchmark::DoNotOptimize(result);
    }
  };
}

void add_group(Groups& groups, Case& c, const std::string& title, const std::string& text) {
  Group& group = groups.emplace_back(title, "ms", 1e3);
  const auto nearest = [](const PreparedCloud& cloud, const TriangleTree& tree) {
    SimdEvaluator evaluator;
    return search_nearest(cloud, tree, evaluator).size();
  };
  group.add("CGAL AABB_tree, build and query", 1, repeat([&c] {
              c.peer.build();
              return c.peer.greatest_squared_distance();
            }));
  group.add("e_max search, build and query", 1, repeat([&c] {
              return searched(c.cloud, TriangleTree(c.mesh.view(), c.cloud.normalization()));
            }));
  group.add("every point's distance, build and query", 1, repeat([&c, nearest] {
              return nearest(c.cloud, TriangleTree(c.mesh.view(), c.cloud.normalization()));
            }));
  group.add("CGAL AABB_tree, query only", 1,
            repeat([&c] { return c.peer.greatest_squared_distance(); }));
  group.add("e_max search, query only", 1, repeat([&c] { return searched(c.cloud, c.tree); }));
  group.add("every point's distance, query only", 1,
            repeat([&c, nearest] { return nearest(c.cloud, c.tree); }));
  const double whole = static_cast<double>(c.cloud.points().size()) / kBruteForcePoints;
  group.add("brute force with SIMD, from a sample", 1 / whole, repeat([&c] {
              SimdEvaluator evaluator;
              return brute_force_emax(*c.sample, *c.sample_tree, evaluator).squared_bits;
            }));
  group.describe(text);
}

}  // namespace

void add_search_groups(Groups& groups) {
  static const TriangleMesh bunny = read_mesh(EMAX_BUNNY);
  static Case noisy(bunny.vertices, displaced(bunny));
  static Case coarse(bunny.vertices, clustered(bunny));
  for (const Case& c : {std::cref(noisy), std::cref(coarse)}) require_agreement(c);

  const auto sizes = [](const Case& c) {
    return fmt::format("{} points of the bunny against {} triangles", c.cloud.points().size(),
                       c.mesh.triangles.size());
  };
  add_group(
      groups, noisy, "e_max against a fine mesh",
      fmt::format(
          "{}: its own, every vertex displaced by up to {} % of the diagonal along each axis. The "
          "cloud is prepared beforehand, as in an optimization, and CGAL's triangles are converted "
          "beforehand. CGAL (Simple_cartesian<double>, accelerated queries) gives every point's "
          "distance, in double, and so do, in float, the rows that say it; the e_max search only "
          "needs the greatest. Brute force is the time of {} points scaled to the cloud.",
          sizes(noisy), kDisplacement * 100, kBruteForcePoints));
  add_group(groups, coarse, "e_max against a coarse mesh",
            fmt::format("{}: its own, the vertices merged in cells of {} % of the diagonal.",
                        sizes(coarse), kCell * 100));
}

}  // namespace emax::benchmarks
