#include "tests/benchmarks/features/edge_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "host/geometry/merge_vertices.h"
#include "host/geometry/point_tree.h"

namespace emax::benchmarks {
namespace {

constexpr double kSharpTruth = 40, kSharpMesh = 20;  // degrees
constexpr double kMostBands = 10;

struct Segment {
  Point from, to;

  double distance(const Point& p) const {
    const Point along = to - from;
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - from - t * along).norm();
  }
};

std::vector<Segment> sharp_edges(TriangleMesh mesh, double degrees) {
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Point>> normals;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const Point normal = (b - a).cross(c - a);
    if (!(normal.norm() > 0)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = mesh.triangles[t][k], j = mesh.triangles[t][(k + 1) % 3];
      normals[std::minmax(i, j)].push_back(normal.normalized());
    }
  }
  std::vector<Segment> edges;
  const double limit = std::cos(degrees * std::numbers::pi / 180);
  for (const auto& [edge, both] : normals) {
    if (both.size() != 2 || both[0].dot(both[1]) > limit) continue;
    edges.push_back({mesh.vertices[edge.first], mesh.vertices[edge.second]});
  }
  return edges;
}

}  // namespace

EdgeDistance distance_of_edges(const TriangleMesh& truth, const TriangleMesh& mesh,
                               std::span<const Point> cloud, double band) {
  const PointTree tree(cloud);
  const std::vector<Segment> edges = sharp_edges(mesh, kSharpMesh);
  std::vector<double> distances;
  std::vector<PointTree::Neighbour> near;
  for (const Segment& edge : sharp_edges(truth, kSharpTruth)) {
    const int count = std::max(1, static_cast<int>((edge.to - edge.from).norm() / band));
    for (int i = 0; i < count; ++i) {
      const Point p = edge.from + (i + 0.5) / count * (edge.to - edge.from);
      tree.nearest(p, 1, near);
      if ((cloud[near.front().index] - p).norm() > band) continue;
      double nearest = kMostBands * band;
      for (const Segment& other : edges) nearest = std::min(nearest, other.distance(p));
      distances.push_back(nearest);
    }
  }
  EdgeDistance found;
  found.samples = distances.size();
  if (distances.empty()) return found;
  std::ranges::sort(distances);
  const auto n = static_cast<double>(distances.size());
  for (const double d : distances) {
    found.mean += d / n;
    found.within_half += d <= band / 2 ? 1 / n : 0;
  }
  found.p95 = distances[static_cast<std::size_t>(0.95 * (n - 1))];
  return found;
}

}  // namespace emax::benchmarks
