// Poisson reconstruction (paper, section 2.1 and [2]) through PCL.
#include <pcl/surface/poisson.h>

#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/methods.h"

namespace emax {

Reconstruction PoissonSurface::run(const LocalCloud& cloud, const ParameterValues& values) const {
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(static_cast<int>(values.at("poisson.depth")));
  poisson.setSamplesPerNode(static_cast<float>(values.at("poisson.samples_per_node")));
  poisson.setScale(static_cast<float>(values.at("poisson.scale")));
  poisson.setThreads(1);
  poisson.setInputCloud(cloud.with_normals(values));
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
  return result;
}

}  // namespace emax
