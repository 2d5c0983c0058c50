// Poisson reconstruction (paper, section 2.1 and [2]) through PCL.
#include <pcl/surface/poisson.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/point_tree.h"
#include "host/parameters/registry.h"
#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/reconstruction.h"

namespace emax {
namespace {

// Poisson's surface is closed whatever the scan is: it goes on where no points are, over holes,
// beyond borders and across the air between parts. Vertices farther from the nearest point than
// `spacings` of those around it go, with their triangles.
void trim(TriangleMesh& mesh, const LocalCloud& cloud, double spacings) {
  constexpr std::size_t kNeighbour = 10;  // the neighbour whose distance tells the density
  std::vector<Point> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.original(i));
  const PointTree tree(points);
  std::vector<PointTree::Neighbour> near;
  std::vector<bool> gone;
  gone.reserve(mesh.vertices.size());
  for (const Point& vertex : mesh.vertices) {
    tree.nearest(vertex, 1, near);
    const double squared = near.front().squared_distance;
    tree.nearest(points[near.front().index], kNeighbour + 1, near);
    const double area =
        std::numbers::pi * near.back().squared_distance / static_cast<double>(near.size() - 1);
    gone.push_back(squared > spacings * spacings * area);
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::ranges::any_of(t, [&](std::uint32_t v) { return gone[v]; });
  });
}

}  // namespace

Reconstruction Poisson::run(const LocalCloud& cloud, const ParameterValues& values,
                            std::size_t threads) {
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(values.at(kDepth));
  poisson.setSamplesPerNode(static_cast<float>(values.at(kSamplesPerNode)));
  poisson.setScale(static_cast<float>(values.at(kScale)));
  poisson.setThreads(1);
  poisson.setInputCloud(cloud.with_normals(values, threads));
  pcl::PointCloud<pcl::PointNormal> points;
  std::vector<pcl::Vertices> polygons;
  poisson.reconstruct(points, polygons);

  Reconstruction result;
  result.mesh.vertices.reserve(points.size());
  for (const pcl::PointNormal& p : points) {
    result.mesh.vertices.push_back(cloud.world(p.getVector3fMap()));
  }
  result.mesh.triangles.reserve(polygons.size());
  for (const pcl::Vertices& polygon : polygons) {
    Triangle& t = result.mesh.triangles.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      t[corner] = static_cast<std::uint32_t>(polygon.vertices[corner]);
    }
  }
  trim(result.mesh, cloud, values.at(kTrim));
  return result;
}

}  // namespace emax
