#include <fmt/format.h>

#include <deque>
#include <memory>

#include "host/engine/mesh_batch.h"
#include "tests/benchmarks/embree_peer.h"
#include "tests/benchmarks/engine.h"
#include "tests/benchmarks/groups.h"

namespace emax::benchmarks {
namespace {

struct Sequence {
  explicit Sequence(SequenceCase made) : given(std::move(made)), cloud(given.cloud), engine(cloud) {
    for (const TriangleMesh& mesh : given.meshes) {
      views.push_back(mesh.view());
      meshes.push_back(std::make_unique<EngineMesh>(engine_mesh(mesh.view(), cloud)));
    }
  }

  SequenceCase given;
  PreparedCloud cloud;
  Engine engine;
  std::vector<MeshView> views;
  std::vector<std::unique_ptr<EngineMesh>> meshes;
};

struct Pair {
  explicit Pair(BenchmarkCase made)
      : mesh(std::move(made.mesh)),
        cloud(made.cloud),
        engine(cloud),
        embree(made.cloud, neighbour_order(cloud), mesh.view(), cloud.normalization()) {}

  EngineMesh fresh_mesh() const { return engine_mesh(mesh.view(), cloud); }

  TriangleMesh mesh;
  PreparedCloud cloud;
  Engine engine;
  EmbreePeer embree;
};

// An iteration does `amount` of what the groups of the curve count.
void add_size(Curve& curve, double at, double amount, BenchmarkCase made) {
  static std::deque<Pair> pairs;  // they live as long as the benchmarks
  Pair& p = pairs.emplace_back(std::move(made));
  const std::string way =
      fmt::format("{} points, {} triangles", p.cloud.points().size(), p.mesh.triangles.size());
  curve.at.push_back(at);
  curve.lines[0].second->add(way, amount, repeat([&p] {
                               p.engine.forget();
                               return p.engine.e_max(p.fresh_mesh());
                             }));
  curve.lines[1].second->add(way, amount, repeat([&p] {
                               p.engine.forget();
                               return p.engine.squared_distances(p.fresh_mesh()).size();
                             }));
  curve.lines[2].second->add(way, amount, repeat([&p] {
                               p.embree.build();
                               return p.embree.greatest_squared_distance(EmbreePeer::Mode::kHints);
                             }));
}

Curve make_curve(Groups& groups, Curve curve, const std::string& text, double units_per_second) {
  for (const char* line : {"emax, e_max", "emax, every point's distance", "Embree"}) {
    Group& group = groups.emplace_back(fmt::format("Scaling with {}: {}", curve.axis, line),
                                       curve.unit, units_per_second);
    group.describe(text);
    curve.lines.emplace_back(line, &group);
  }
  return curve;
}

void add_batch_group(Groups& groups, const Sequence& s) {
  Group& group =
      groups.emplace_back("The same meshes as a batch, " + s.given.name, "ms a mesh", 1e3);
  group.describe(
      "Each mesh is prepared and queried by one thread. Wall-clock time, in which other work on "
      "the machine shows.");
  for (const std::size_t threads : {1u, 2u}) {
    EngineOptions options;
    options.threads = threads;
    group.add(threads == 1 ? "one thread" : "two threads", static_cast<double>(s.views.size()),
              repeat([&s, options] { return e_max_of_each(s.cloud, s.views, options).size(); }),
              Group::Clock::kWall);
  }
}

}  // namespace

void add_sequence_groups(Groups& groups, const CaseFolders& folders, bool quick) {
  static std::deque<Sequence> sequences;
  for (SequenceCase& made : sequence_cases(folders, quick)) {
    Sequence& s = sequences.emplace_back(std::move(made));
    Group& group = groups.emplace_back("A sequence of meshes, " + s.given.name, "ms a mesh", 1e3);
    group.describe(fmt::format(
        "{}, {} to {} triangles. In the warm row the first mesh follows the last.", s.given.text,
        s.given.meshes.front().triangles.size(), s.given.meshes.back().triangles.size()));
    const auto amount = static_cast<double>(s.meshes.size());
    group.add("e_max, query, cold", amount, repeat([&s] {
                std::uint32_t bits = 0;
                for (const auto& mesh : s.meshes) {
                  s.engine.forget();
                  bits ^= s.engine.e_max(*mesh).squared_bits;
                }
                return bits;
              }));
    group.add("e_max, query, warm from the mesh before", amount, repeat([&s] {
                std::uint32_t bits = 0;
                for (const auto& mesh : s.meshes) bits ^= s.engine.e_max(*mesh).squared_bits;
                return bits;
              }));
    group.add("of which: the mesh before's triangles found in this one", amount, repeat([&s] {
                std::size_t found = 0;
                const EngineMesh* before = s.meshes.back().get();
                for (const auto& mesh : s.meshes) {
                  found += before->leaves()->carried_to(*mesh->leaves()).size();
                  before = mesh.get();
                }
                return found;
              }));
    group.add("mesh prepared", amount, repeat([&s] {
                std::size_t records = 0;
                for (const TriangleMesh& mesh : s.given.meshes) {
                  records += engine_mesh(mesh.view(), s.cloud).records().size();
                }
                return records;
              }));
    add_batch_group(groups, s);
  }
}

void add_thread_groups(Groups& groups, const CaseFolders& folders) {
  static const BenchmarkCase dragon = dragon_case(folders, 99000);
  static const PreparedCloud cloud(dragon.cloud);
  static const EngineMesh mesh = engine_mesh(dragon.mesh.view(), cloud);
  static Engine one(cloud), two(cloud, {2});
  const auto add = [&](const std::string& title, auto ask) {
    Group& group = groups.emplace_back("Threads, dragon-99k: " + title, "ms", 1e3);
    group.describe("Wall-clock time, in which other work on the machine shows.");
    for (Engine* engine : {&one, &two}) {
      group.add(engine == &one ? "one thread" : "two threads", 1, repeat([engine, ask] {
                  engine->forget();
                  return ask(*engine);
                }),
                Group::Clock::kWall);
    }
  };
  add("e_max, query", [](Engine& engine) { return engine.e_max(mesh); });
  add("every point's distance, query",
      [](Engine& engine) { return engine.squared_distances(mesh).size(); });
  add("e_max, mesh prepared and queried", [](Engine& engine) {
    return engine.e_max(
        engine_mesh(dragon.mesh.view(), cloud, engine_targets().front(), &engine == &one ? 1 : 2));
  });
}

std::vector<Curve> add_scaling_groups(Groups& groups, const CaseFolders& folders) {
  std::vector<Curve> curves;
  curves.push_back(make_curve(
      groups, {"scaling_points", "points", "ns a point", {}, {}},
      fmt::format("Points spread over the dragon's surface against its mesh decimated to one "
                  "triangle for {} points; mesh prepared and queried.",
                  kScalingRatio),
      1e9));
  for (const double points : {1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7}) {
    add_size(curves.back(), points, points,
             surface_case(folders, static_cast<std::size_t>(points)));
  }
  curves.push_back(make_curve(
      groups, {"scaling_triangles", "triangles", "ms", {}, {}},
      "The dragon's vertices against its mesh decimated; mesh prepared and queried.", 1e3));
  for (const double triangles : {1e3, 3e3, 1e4, 2e4, 5e4, 99e3, 2e5, 4e5}) {
    add_size(curves.back(), triangles, 1,
             dragon_case(folders, static_cast<std::size_t>(triangles)));
  }
  return curves;
}

}  // namespace emax::benchmarks
