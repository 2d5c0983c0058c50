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
#include "sw_model/certify/exact_distance.h"

namespace emax::benchmarks {
namespace {

constexpr double kSharpTruth = 40, kSharpMesh = 20;  // degrees
constexpr double kMostBands = 10;
constexpr double kReach = 2;  // bands, from a point of a plane to a line on it

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

double nearest_of(const std::vector<Segment>& edges, const Point& p, double most) {
  for (const Segment& edge : edges) most = std::min(most, edge.distance(p));
  return most;
}

EdgeDistance summed_up(std::vector<double> distances, double band) {
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

// The line where two planes meet, with the part that has points of the first one near it.
struct MeetingLine {
  Point origin, direction;
  double from = HUGE_VAL, to = -HUGE_VAL;

  MeetingLine(const Plane& a, const Plane& b, std::span<const Point> points, double reach)
      : direction(a.normal.cross(b.normal).normalized()) {
    Eigen::Matrix3d normals;
    normals << a.normal.transpose(), b.normal.transpose(), direction.transpose();
    const Point& near = points.front();
    origin = near - normals.inverse() * Point(a.signed_distance(near), b.signed_distance(near), 0);
    for (const Point& p : points) {
      const double along = direction.dot(p - origin);
      if ((p - origin - along * direction).norm() > reach) continue;
      from = std::min(from, along);
      to = std::max(to, along);
    }
  }
};

}  // namespace

EdgeDistance distance_of_meeting_planes(std::span<const FoundPlane> planes,
                                        std::span<const Point> cloud, const TriangleMesh& reference,
                                        const TriangleMesh& mesh, double band) {
  const double flat = std::cos(kSharpTruth * std::numbers::pi / 180), reach = kReach * band;
  std::vector<std::vector<Point>> points(planes.size());
  std::vector<PointTree> trees;
  trees.reserve(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (const std::uint32_t p : planes[i].points) points[i].push_back(cloud[p]);
    trees.emplace_back(points[i]);
  }
  const ExactMesh surface(reference.view());
  const std::vector<Segment> edges = sharp_edges(mesh, kSharpMesh);
  std::vector<double> distances;
  std::vector<PointTree::Neighbour> near;
  const auto has_point = [&](std::size_t i, const Point& p) {
    trees[i].nearest(p, 1, near);
    return (points[i][near.front().index] - p).norm() <= reach;
  };
  for (std::size_t a = 0; a < planes.size(); ++a) {
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      const Plane &first = planes[a].plane, &second = planes[b].plane;
      if (std::abs(first.normal.dot(second.normal)) > flat) continue;
      const MeetingLine line(first, second, points[a], reach);
      for (int i = 0; line.from + 0.5 * i * band <= line.to; ++i) {
        const Point p = line.origin + (line.from + 0.5 * i * band) * line.direction;
        if (!has_point(a, p) || !has_point(b, p)) continue;
        if (surface.nearest(p, band).distance.upper > band) continue;
        distances.push_back(nearest_of(edges, p, kMostBands * band));
      }
    }
  }
  return summed_up(std::move(distances), band);
}

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
      distances.push_back(nearest_of(edges, p, kMostBands * band));
    }
  }
  return summed_up(std::move(distances), band);
}

}  // namespace emax::benchmarks
