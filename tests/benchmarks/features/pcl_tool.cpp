#include <pcl/ModelCoefficients.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <numeric>

#include "host/features/plane_fit.h"
#include "tests/benchmarks/features/plane_tools.h"

namespace emax::benchmarks {

// The plane with the most points is taken out until the next has too few, as PCL's tutorial does.
// Its random numbers have a fixed seed of their own.
std::vector<FoundPlane> planes_of_pcl_ransac(const PlaneTask& task) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const Point& p : task.cloud) {
    cloud->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                        static_cast<float>(p.z()));
  }
  auto left = std::make_shared<pcl::Indices>(cloud->size());
  std::iota(left->begin(), left->end(), 0);
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setDistanceThreshold(task.band);
  segmentation.setMaxIterations(1000);
  segmentation.setOptimizeCoefficients(true);
  segmentation.setInputCloud(cloud);
  std::vector<FoundPlane> found;
  while (left->size() >= task.least_support) {
    segmentation.setIndices(left);
    pcl::PointIndices inliers;
    pcl::ModelCoefficients coefficients;
    segmentation.segment(inliers, coefficients);
    if (inliers.indices.size() < task.least_support) break;
    std::vector<std::uint32_t> members;
    for (const int i : inliers.indices) members.push_back(static_cast<std::uint32_t>(i));
    std::ranges::sort(members);
    auto rest = std::make_shared<pcl::Indices>();
    for (const int i : *left) {
      if (!std::ranges::binary_search(members, static_cast<std::uint32_t>(i))) rest->push_back(i);
    }
    left = rest;
    const Plane plane = fit_plane(task.cloud, members).plane;
    found.push_back({plane, std::move(members)});
  }
  return found;
}

}  // namespace emax::benchmarks
