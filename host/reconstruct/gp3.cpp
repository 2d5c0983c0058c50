// Greedy projection triangulation (paper, section 2.1 and [3]) through PCL.
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>

#include <algorithm>
#include <numbers>

#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/mesh_orientation.h"
#include "host/reconstruct/methods.h"

namespace emax {

Reconstruction GreedyProjection::run(const LocalCloud& cloud, const ParameterValues& values) const {
  const auto points = cloud.with_normals(values);
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
  drop_folds(mesh);
  orient_consistently(mesh, normals);
  return result;
}

}  // namespace emax
