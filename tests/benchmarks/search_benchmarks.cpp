#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "host/block_search/block_search.h"
#include "host/block_search/simd_evaluator.h"
#include "host/geometry/bounds.h"
#include "sw_model/base/error.h"
#include "sw_model/base/float_bits.h"
#include "tests/benchmarks/cgal_peer.h"
#include "tests/benchmarks/embree_peer.h"
#include "tests/benchmarks/engine.h"
#include "tests/benchmarks/foreign_peers.h"
#include "tests/benchmarks/groups.h"

namespace emax::benchmarks {
namespace {

constexpr std::size_t kBruteForcePoints = 256;
// By which e_max of the ways may differ, of the cloud's half-extent; on slivers the distances of
// peers in float lose digits, and their tables say what they give.
constexpr double kAgreement = 1e-6, kSliverAgreement = 0.01;

std::vector<Point> sampled(std::span<const Point> points) {
  std::vector<Point> some;
  for (std::size_t i = 0; i < kBruteForcePoints; ++i) {
    some.push_back(points[i * points.size() / kBruteForcePoints]);
  }
  return some;
}

// A case and what its ways work on.
struct Prepared {
  explicit Prepared(BenchmarkCase made)
      : given(std::move(made)),
        cloud(given.cloud),
        order(neighbour_order(cloud)),
        engine(cloud),
        mesh(engine_mesh(given.mesh.view(), cloud)),
        cgal(given.cloud, order, given.mesh.view()),
        embree(given.cloud, order, given.mesh.view(), cloud.normalization()),
        sample(sampled(given.cloud)),
        sample_tree(given.mesh.view(), sample.normalization()) {}

  EngineMesh fresh_mesh() const { return engine_mesh(given.mesh.view(), cloud); }

  BenchmarkCase given;
  PreparedCloud cloud;
  std::vector<std::uint32_t> order;
  Engine engine;
  EngineMesh mesh;
  CgalPeer cgal;
  EmbreePeer embree;
  PreparedCloud sample;
  TriangleTree sample_tree;
};

bool slivers(const Prepared& p) { return p.given.name == "slivers"; }

// Compares e_max of all ways, in normalised units where the cloud's half-extent is in (1/2, 1].
// Returns what is to be said of peers in float that are off.
std::string compare(Prepared& p) {
  const EmaxResult result = p.engine.e_max(p.mesh);
  const double ours = distance_of(result.squared_bits);
  const auto require = [&](const std::string& way, double theirs, double tolerance = kAgreement) {
    if (std::abs(ours - theirs) <= tolerance) return;
    throw Error(fmt::format("{}: e_max is {} by the search, {} by {}; find out which is wrong",
                            p.given.name, ours, theirs, way));
  };
  const std::vector<std::uint32_t> every = p.engine.squared_distances(p.mesh);
  if (worst_of(every) != result) {
    throw Error(p.given.name + ": every point's distance and e_max disagree; look at the engine");
  }
  for (const auto mode : {CgalPeer::Mode::kKdTree, CgalPeer::Mode::kHints}) {
    p.cgal.build(mode);
    require("CGAL", p.cloud.normalization().length(std::sqrt(p.cgal.greatest_squared_distance())));
  }
  p.embree.build();
  using Mode = EmbreePeer::Mode;
  const double exact = std::sqrt(p.embree.greatest_squared_distance(Mode::kNeighbours));
  const double tolerance = slivers(p) ? kSliverAgreement : kAgreement;
  require("Embree", exact, tolerance);
  for (std::size_t i = 0; i < every.size(); ++i) {
    const double theirs = std::sqrt(p.embree.squared_distances()[i]);
    if (std::abs(distance_of(every[i]) - theirs) <= tolerance) continue;
    throw Error(
        fmt::format("{}: point {} is {} away by the engine, {} by Embree; find out which "
                    "is wrong",
                    p.given.name, i, distance_of(every[i]), theirs));
  }
  require("Embree", std::sqrt(p.embree.greatest_squared_distance(Mode::kCloudOrder)), tolerance);
  require("Embree", std::sqrt(p.embree.greatest_squared_distance(Mode::kHints)), tolerance);
  require("Embree with early stop", std::sqrt(p.embree.greatest_with_early_stop()), tolerance);
  if (std::abs(ours - exact) <= kAgreement) return {};
  return fmt::format(" Embree's e_max, with Ericson's form in float, differs by {:+.2g} of e_max.",
                     exact / ours - 1);
}

std::uint32_t squared_bits(double distance) {
  return float_bits(static_cast<float>(distance * distance));
}

void add_peers(Group& group, Prepared& p) {
  const auto cgal = [&](const std::string& way, CgalPeer::Mode mode) {
    group.add_peer("CGAL AABB_tree" + way, 1, repeat([&p, mode] {
                     p.cgal.build(mode);
                     return p.cgal.greatest_squared_distance();
                   }));
  };
  cgal(" with its kd-tree, build and query", CgalPeer::Mode::kKdTree);
  cgal(" with the last point as hint, build and query", CgalPeer::Mode::kHints);
  const auto embree = [&](const std::string& way, EmbreePeer::Mode mode) {
    group.add_peer("Embree" + way, 1, repeat([&p, mode] {
                     p.embree.build();
                     return p.embree.greatest_squared_distance(mode);
                   }));
  };
  embree(", cloud order, build and query", EmbreePeer::Mode::kCloudOrder);
  embree(", neighbours in a row, build and query", EmbreePeer::Mode::kNeighbours);
  embree(", the last point's triangle as bound, build and query", EmbreePeer::Mode::kHints);
  group.add_foreign_peer(kOpen3d);
  group.add_foreign_peer(kFcpw);
  group.add(kEarlyStop, 1, repeat([&p] {
              p.embree.build();
              return p.embree.greatest_with_early_stop();
            }));
}

void add_engine(Group& group, Prepared& p) {
  group.add(kCold, 1, repeat([&p] {
              p.engine.forget();
              return p.engine.e_max(p.fresh_mesh());
            }));
  group.add(kColdExact, 1, repeat([&p] {
              p.engine.forget();
              return p.engine.squared_distances(p.fresh_mesh()).size();
            }));
  for (const EngineTarget& target : engine_targets().subspan(1)) {
    EngineOptions options;
    options.target = &target;
    group.add(cold_way(target.name), 1,
              repeat([&p, &target, engine = std::make_shared<Engine>(p.cloud, options)] {
                engine->forget();
                return engine->e_max(engine_mesh(p.given.mesh.view(), p.cloud, target));
              }));
  }
  group.add("emax: mesh prepared", 1, repeat([&p] { return p.fresh_mesh().records().size(); }));
  group.add("emax: e_max, query only", 1, repeat([&p] {
              p.engine.forget();
              return p.engine.e_max(p.mesh);
            }));
  group.add("emax: every point's distance, query only", 1, repeat([&p] {
              p.engine.forget();
              return p.engine.squared_distances(p.mesh).size();
            }));
  const double e_max = distance_of(p.engine.e_max(p.mesh).squared_bits);
  for (const double share : {2.0, 0.8}) {
    group.add(fmt::format("emax: within {} e_max? query only", share), 1,
              repeat([&p, limit = squared_bits(share * e_max)] {
                p.engine.forget();
                return p.engine.violation(p.mesh, limit);
              }));
  }
  group.add("the paper's search with its kd-tree hint: e_max, mesh prepared and queried", 1,
            repeat([&p] {
              SimdEvaluator evaluator;
              const TriangleTree tree(p.given.mesh.view(), p.cloud.normalization());
              return search_emax(p.cloud, tree, evaluator).squared_bits;
            }));
  const double whole = static_cast<double>(p.given.cloud.size()) / kBruteForcePoints;
  group.add("brute force with SIMD, from a sample", 1 / whole, repeat([&p] {
              SimdEvaluator evaluator;
              return brute_force_emax(p.sample, p.sample_tree, evaluator).squared_bits;
            }));
}

}  // namespace

std::string cold_way(std::string_view target) { return fmt::format("{}, {} only", kCold, target); }

std::vector<SearchGroup> add_search_groups(Groups& groups, const CaseFolders& folders, bool quick) {
  static std::deque<Prepared> prepared;
  std::vector<SearchGroup> result;
  for (BenchmarkCase& made : search_cases(folders, quick)) {
    Prepared& p = prepared.emplace_back(std::move(made));
    const std::string off = compare(p);
    const std::size_t points = p.given.cloud.size(), triangles = p.given.mesh.triangles.size();
    const Normalization& unit = p.cloud.normalization();
    const double e_max = distance_of(p.engine.e_max(p.mesh).squared_bits);
    const double percent = 100 * e_max / unit.length(bounds_of(p.given.cloud).width());
    std::vector<Vector3<float>> in_order;
    for (const std::uint32_t i : p.order) in_order.push_back(p.cloud.points()[i]);
    write_case(folders.cache / p.given.name, in_order,
               normalized_points(p.given.mesh.vertices, unit), p.given.mesh.triangles);
    Group& group =
        groups.emplace_back("e_max, " + p.given.name, "ms", 1e3, Group::Reference::kFastestPeer);
    group.describe(fmt::format("{} points, {} triangles: {}. e_max is {:.3f} % of the width.{}",
                               points, triangles, p.given.text, percent, off));
    add_peers(group, p);
    add_engine(group, p);
    result.push_back({p.given.name, points, triangles, e_max, percent,
                      slivers(p) ? kSliverAgreement : kAgreement,
                      static_cast<double>(p.cloud.memory_bytes()) / static_cast<double>(points),
                      static_cast<double>(memory_bytes(p.mesh)) / static_cast<double>(triangles),
                      !slivers(p), &group});
  }
  return result;
}

}  // namespace emax::benchmarks
