#include "tests/benchmarks/decimation/measures.h"

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "host/geometry/mesh_validity.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/benchmarks/cgal_peer.h"

namespace emax::benchmarks {
namespace {

// Degrees: of an edge of the start, and of what stands for it.
constexpr double kSharp = 40, kStillSharp = 25;
constexpr int kSteps = 8;  // into which a side is divided for the distance to the true surface

double cgal_error(const DecimationScan& scan, const TriangleMesh& mesh) {
  std::vector<std::uint32_t> order(scan.cloud.size());
  std::iota(order.begin(), order.end(), 0);
  CgalPeer peer(scan.cloud, order, mesh.view());
  peer.build(CgalPeer::Mode::kKdTree);
  return std::sqrt(peer.greatest_squared_distance());
}

struct TrueDistance {
  double greatest = 0, root_mean_square = 0;
};

// Sampled in every triangle; the mean is over the area.
TrueDistance true_distance(const DecimationScan& scan, const TriangleMesh& mesh) {
  TrueDistance result;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const double share = (b - a).cross(c - a).norm();
    double squares = 0;
    int samples = 0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; i + k <= kSteps; ++k, ++samples) {
        const Point p = a + (i * (b - a) + k * (c - a)) / kSteps;
        const double distance = scan.true_distance(p);
        result.greatest = std::max(result.greatest, distance);
        squares += distance * distance;
      }
    }
    area += share;
    result.root_mean_square += share * squares / samples;
  }
  result.root_mean_square = std::sqrt(result.root_mean_square / area);
  return result;
}

// The edges whose triangles turn by more than `degrees`, each as a triangle without area.
TriangleMesh sharp_edges(const TriangleMesh& mesh, double degrees) {
  const double cosine = std::cos(degrees * std::numbers::pi / 180);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Point> first;  // normal of an edge's triangle
  TriangleMesh edges{mesh.vertices, {}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const Point normal = (b - a).cross(c - a).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      const auto [known, is_new] = first.try_emplace(std::minmax(from, to), normal);
      if (!is_new && known->second.dot(normal) < cosine) edges.triangles.push_back({from, to, to});
    }
  }
  return edges;
}

}  // namespace

nlohmann::json measures(const std::string& what, const DecimationScan& scan, CloudError& error,
                        const TriangleMesh& mesh) {
  const double e_max = error(mesh);
  error.confirm(what, e_max, cgal_error(scan, mesh));
  const auto percent = [&](double length) { return 100 * length / scan.width; };
  const MeshValidity validity = check_mesh(mesh.view());
  const SurfaceDistance back = surface_distance(mesh.view(), ExactMesh(scan.start.view()));
  nlohmann::json result = {
      {"triangles", mesh.triangles.size()},
      {"e_max", percent(e_max)},
      {"back", percent(back.lower)},
      {"intersecting", validity.self_intersecting_triangles},
      {"non_manifold", validity.non_manifold_edges},
      {"degenerate", validity.degenerate_triangles},
  };
  if (scan.sharp) {
    const TriangleMesh from = sharp_edges(scan.start, kSharp), to = sharp_edges(mesh, kStillSharp);
    if (!to.triangles.empty()) {
      result["edges"] = percent(surface_distance(from.view(), ExactMesh(to.view())).lower);
    }
  }
  if (scan.true_distance) {
    const TrueDistance truth = true_distance(scan, mesh);
    result["true_greatest"] = percent(truth.greatest);
    result["true_rms"] = percent(truth.root_mean_square);
  }
  return result;
}

}  // namespace emax::benchmarks
