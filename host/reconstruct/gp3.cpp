// Greedy projection triangulation (paper, section 2.1 and [3]) through PCL.
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "host/parameters/registry.h"
#include "host/reconstruct/greedy_projection.h"
#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/reconstruction.h"
#include "host/surface/mesh_orientation.h"

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

std::pair<std::uint32_t, std::uint32_t> edge(const Triangle& t, std::size_t i) {
  return std::minmax(t[i], t[(i + 1) % 3]);
}

// The edge from corner i to the next one.
std::size_t longest_edge(const TriangleMesh& mesh, const Triangle& t) {
  const auto length = [&](std::size_t i) {
    return (mesh.vertices[t[(i + 1) % 3]] - mesh.vertices[t[i]]).norm();
  };
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) longest = length(i) > length(longest) ? i : longest;
  return longest;
}

double height(const TriangleMesh& mesh, const Triangle& t) {
  const auto& v = mesh.vertices;
  const Point a = v[t[1]] - v[t[0]], b = v[t[2]] - v[t[0]];
  const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
  return longest > 0 ? a.cross(b).norm() / longest : 0;
}

// Removes the triangles that the steps have made of points on a line, flatter than `flat`: at a
// border they go; elsewhere the neighbour across the longest edge is split at the vertex on it.
void remove_slivers(TriangleMesh& mesh, double flat) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  constexpr int kRounds = 10;  // slivers beside slivers
  for (int round = 0; round < kRounds; ++round) {
    std::map<Edge, std::vector<std::size_t>> users;  // of the edges of slivers, which are few
    std::vector<std::size_t> slivers;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (height(mesh, mesh.triangles[t]) >= flat) continue;
      slivers.push_back(t);
      for (std::size_t i = 0; i < 3; ++i) users[edge(mesh.triangles[t], i)];
    }
    if (slivers.empty()) return;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto found = users.find(edge(mesh.triangles[t], i));
        if (found != users.end()) found->second.push_back(t);
      }
    }
    std::vector<bool> changed(mesh.triangles.size(), false), gone(mesh.triangles.size(), false);
    for (const std::size_t s : slivers) {
      const Triangle sliver = mesh.triangles[s];
      const std::size_t i = longest_edge(mesh, sliver);
      const std::vector<std::size_t>& sides = users[edge(sliver, i)];
      if (changed[s] || sides.size() > 2) continue;
      if (sides.size() == 1) {
        gone[s] = true;
        continue;
      }
      const std::size_t other = sides[0] == s ? sides[1] : sides[0];
      if (changed[other] || gone[other]) continue;
      const std::uint32_t from = sliver[i], to = sliver[(i + 1) % 3], middle = sliver[(i + 2) % 3];
      const Triangle across = mesh.triangles[other];
      const std::uint32_t apex = across[0] ^ across[1] ^ across[2] ^ from ^ to;
      mesh.triangles[s] = {from, apex, middle};
      mesh.triangles[other] = {apex, to, middle};
      changed[s] = changed[other] = true;
    }
    std::size_t t = 0;
    std::erase_if(mesh.triangles, [&](const Triangle&) { return gone[t++]; });
  }
}

// Those that no triangle has as a corner.
std::size_t unmeshed_points(const LocalCloud& cloud, const TriangleMesh& mesh) {
  std::vector<bool> meshed(cloud.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) meshed[corner] = true;
  }
  std::size_t unmeshed = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!meshed[i]) unmeshed += cloud.multiplicity(i);
  }
  return unmeshed;
}

}  // namespace

TriangleMesh greedy_projection(const LocalCloud& cloud, std::span<const Eigen::Vector3f> normals,
                               const ParameterValues& values) {
  const auto points = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  points->resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    (*points)[i].getVector3fMap() = (*cloud.points())[i].getVector3fMap();
    (*points)[i].getNormalVector3fMap() = normals[i];
  }
  if (cloud.is_regular()) break_ties(*points, cloud.spacing());
  const double radians = std::numbers::pi / 180;
  // PCL searches this many neighbours without asking how many there are.
  const int max_neighbors = std::min(values.at(Gp3::kMaxNeighbors), static_cast<int>(cloud.size()));
  pcl::GreedyProjectionTriangulation<pcl::PointNormal> gp3;
  gp3.setSearchRadius(values.at(Gp3::kRadius) * cloud.spacing());
  gp3.setMu(values.at(Gp3::kMu));
  gp3.setMaximumNearestNeighbors(max_neighbors);
  gp3.setMaximumSurfaceAngle(values.at(Gp3::kSurfaceAngle) * radians);
  gp3.setMinimumAngle(values.at(Gp3::kMinAngle) * radians);
  gp3.setMaximumAngle(values.at(Gp3::kMaxAngle) * radians);
  gp3.setNormalConsistency(true);
  gp3.setInputCloud(points);
  gp3.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  std::vector<pcl::Vertices> polygons;
  gp3.reconstruct(polygons);

  TriangleMesh mesh;
  mesh.vertices.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) mesh.vertices[i] = cloud.original(i);
  mesh.triangles.reserve(polygons.size());
  for (const pcl::Vertices& polygon : polygons) {
    Triangle& t = mesh.triangles.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      t[corner] = static_cast<std::uint32_t>(polygon.vertices[corner]);
    }
  }
  return mesh;
}

Reconstruction Gp3::run(const LocalCloud& cloud, const ParameterValues& values,
                        std::size_t threads) {
  const std::vector<Eigen::Vector3f> normals = cloud.oriented_normals(values, threads).normals;
  Reconstruction result;
  TriangleMesh& mesh = result.mesh;
  mesh = greedy_projection(cloud, normals, values);
  result.unmeshed_points = unmeshed_points(cloud, mesh);
  if (cloud.is_regular()) {
    const double spacing =
        (cloud.world({1, 0, 0}) - cloud.world({0, 0, 0})).norm() * cloud.spacing();
    remove_slivers(mesh, 4 * kTieBreak * spacing);
  }
  drop_folds(mesh);
  orient_consistently(mesh, normals);
  return result;
}

}  // namespace emax
