#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <span>
#include <vector>

#include "host/parameters/parameter.h"
#include "sw_model/base/mesh_view.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The cloud as PCL is given it: distinct points, normalised and in binary32.
class LocalCloud {
 public:
  // Throws Error when fewer than three distinct points are left.
  explicit LocalCloud(std::span<const Point> points);

  const pcl::PointCloud<pcl::PointXYZ>::Ptr& points() const { return points_; }
  std::size_t size() const { return points_->size(); }
  double spacing() const { return spacing_; }  // median distance to the nearest neighbour
  // Whether points stand on a grid: at least a tenth of them has its nearest neighbour at the
  // median distance to within 1e-4 of it, and a tenth another point opposite of that neighbour to
  // within 1e-3. Scans do not have that by chance.
  bool is_regular() const { return is_regular_; }

  Point world(const Eigen::Vector3f& local) const {
    return local.cast<double>() / normalization_.scale + normalization_.origin;
  }
  // A local point as it stands in the cloud, without its rounding.
  const Point& original(std::size_t local_index) const { return source_[first_[local_index]]; }
  // Points of the cloud that coincide with a local point, itself included.
  std::size_t multiplicity(std::size_t local_index) const { return multiplicity_[local_index]; }

  // Unit normals by principal components of Normals::kNeighbours nearest neighbours (Hoppe's
  // tangent planes; paper, section 2.1), made consistent by orient_normals over
  // Normals::kOrientationNeighbours of them. O(n k + n log n).
  std::vector<Eigen::Vector3f> oriented_normals(const ParameterValues& values) const;
  // The same, as PCL wants them.
  pcl::PointCloud<pcl::PointNormal>::Ptr with_normals(const ParameterValues& values) const;

 private:
  std::span<const Point> source_;
  Normalization normalization_;
  double spacing_;
  bool is_regular_;
  pcl::PointCloud<pcl::PointXYZ>::Ptr points_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> multiplicity_;
};

}  // namespace emax
