// Greedy projection triangulation (paper, section 2.1 and [3]) through PCL.
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/mesh_orientation.h"
#include "host/reconstruct/methods.h"

namespace emax {
namespace {

constexpr double kTieBreak = 1e-3;  // of the spacing

// A number in [-1, 1) that depends on `n` alone (splitmix64).
double scattered(std::uint64_t n) {
  n += 0x9e3779b97f4a7c15u;
  n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9u;
  n = (n ^ (n >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((n ^ (n >> 31)) >> 11) * 0x1p-52 - 1;
}

// PCL's tests of visibility between edges fail where points stand on a grid, exactly collinear, and
// tear planes into shards. A small step of each point leaves no such ties.
void break_ties(pcl::PointCloud<pcl::PointNormal>& points, double spacing) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      points[i].getVector3fMap()[k] += static_cast<float>(
          kTieBreak * spacing * scattered(3 * std::uint64_t{i} + static_cast<std::uint64_t>(k)));
    }
  }
}

double height(const TriangleMesh& mesh, const Triangle& t) {
  const auto& v = mesh.vertices;
  const Point a = v[t[1]] - v[t[0]], b = v[t[2]] - v[t[0]];
  const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
  return longest > 0 ? a.cross(b).norm() / longest : 0;
}

// Drops the triangles that the steps have made along a straight border, flatter than these.
void drop_border_slivers(TriangleMesh& mesh, double flat) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  const auto edge = [](const Triangle& t, std::size_t i) -> Edge {
    return std::minmax(t[i], t[(i + 1) % 3]);
  };
  for (bool dropped = true; dropped;) {
    std::map<Edge, int> users;  // of the edges of flat triangles, which are few
    for (const Triangle& t : mesh.triangles) {
      if (height(mesh, t) >= flat) continue;
      for (std::size_t i = 0; i < 3; ++i) users[edge(t, i)] = 0;
    }
    if (users.empty()) return;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (const auto found = users.find(edge(t, i)); found != users.end()) ++found->second;
      }
    }
    const auto is_border_sliver = [&](const Triangle& t) {
      if (height(mesh, t) >= flat) return false;
      return users[edge(t, 0)] == 1 || users[edge(t, 1)] == 1 || users[edge(t, 2)] == 1;
    };
    dropped = std::erase_if(mesh.triangles, is_border_sliver) > 0;
  }
}

}  // namespace

Reconstruction GreedyProjection::run(const LocalCloud& cloud, const ParameterValues& values) const {
  const auto points = cloud.with_normals(values);
  if (cloud.is_regular()) break_ties(*points, cloud.spacing());
  const double radians = std::numbers::pi / 180;
  // PCL searches this many neighbours without asking how many there are.
  const int max_neighbors =
      std::min(static_cast<int>(values.at("gp3.max_neighbors")), static_cast<int>(cloud.size()));
  pcl::GreedyProjectionTriangulation<pcl::PointNormal> gp3;
  gp3.setSearchRadius(values.at("gp3.radius") * cloud.spacing());
  gp3.setMu(values.at("gp3.mu"));
  gp3.setMaximumNearestNeighbors(max_neighbors);
  gp3.setMaximumSurfaceAngle(values.at("gp3.surface_angle") * radians);
  gp3.setMinimumAngle(values.at("gp3.min_angle") * radians);
  gp3.setMaximumAngle(values.at("gp3.max_angle") * radians);
  gp3.setNormalConsistency(true);
  gp3.setInputCloud(points);
  gp3.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  std::vector<pcl::Vertices> polygons;
  gp3.reconstruct(polygons);

  Reconstruction result;
  TriangleMesh& mesh = result.mesh;
  mesh.vertices.resize(cloud.size());
  std::vector<Eigen::Vector3f> normals(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    mesh.vertices[i] = cloud.original(i);
    normals[i] = (*points)[i].getNormalVector3fMap();
  }
  mesh.triangles.reserve(polygons.size());
  std::vector<bool> meshed(cloud.size(), false);
  for (const pcl::Vertices& polygon : polygons) {
    Triangle& t = mesh.triangles.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      t[corner] = static_cast<std::uint32_t>(polygon.vertices[corner]);
      meshed[t[corner]] = true;
    }
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!meshed[i]) result.unmeshed_points += cloud.multiplicity(i);
  }
  if (cloud.is_regular()) {
    const double spacing =
        (cloud.world({1, 0, 0}) - cloud.world({0, 0, 0})).norm() * cloud.spacing();
    drop_border_slivers(mesh, 4 * kTieBreak * spacing);
  }
  drop_folds(mesh);
  orient_consistently(mesh, normals);
  return result;
}

}  // namespace emax
