#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/parameters/parameter.h"
#include "sw_model/base/mesh_view.h"
#include "sw_model/model/normalization.h"

namespace emax {

inline constexpr std::size_t kPointsAtATime = 1024;  // that a thread takes

struct OrientedNormals {
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::uint32_t> part;  // as orient_normals() gives it
};

// The cloud as PCL is given it: distinct points, normalised and in binary32. Not for concurrent
// use.
class LocalCloud {
 public:
  // Throws Error when fewer than three distinct points are left. The points must outlive it.
  explicit LocalCloud(std::span<const Point> points);
  // A part of a cloud, which is normalised as the whole is.
  LocalCloud(std::span<const Point> points, const Normalization& normalization);

  const pcl::PointCloud<pcl::PointXYZ>::Ptr& points() const { return points_; }
  std::size_t size() const { return points_->size(); }
  double spacing() const { return looked_at().spacing; }  // median distance to the next neighbour
  // Whether points stand on a grid: at least a tenth of them has its nearest neighbour at the
  // median distance to within 1e-4 of it, and a tenth another point opposite of that neighbour to
  // within 1e-3. Scans do not have that by chance.
  bool is_regular() const { return looked_at().is_regular; }

  Point world(const Eigen::Vector3f& local) const {
    return normalization_.invert(local.cast<double>());
  }
  const Normalization& normalization() const { return normalization_; }
  // A local point as it stands in the cloud, without its rounding.
  const Point& original(std::size_t local_index) const { return source_[first_[local_index]]; }
  // The number of that one in the cloud.
  std::size_t index(std::size_t local_index) const { return first_[local_index]; }
  // Points of the cloud that coincide with a local point, itself included.
  std::size_t multiplicity(std::size_t local_index) const { return multiplicity_[local_index]; }

  // Unit normals by principal components of Normals::kNeighbours nearest neighbours (Hoppe's
  // tangent planes; paper, section 2.1), made consistent by orient_normals over
  // Normals::kOrientationNeighbours of them. O(n k + n log n).
  OrientedNormals oriented_normals(const ParameterValues& values, std::size_t threads = 1) const;
  // The same, as PCL wants them.
  pcl::PointCloud<pcl::PointNormal>::Ptr with_normals(const ParameterValues& values,
                                                      std::size_t threads = 1) const;

 private:
  struct Look {
    double spacing;
    bool is_regular;
  };
  const Look& looked_at() const;

  std::span<const Point> source_;
  Normalization normalization_;
  mutable std::optional<Look> look_;  // once it is asked for
  pcl::PointCloud<pcl::PointXYZ>::Ptr points_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> multiplicity_;
};

}  // namespace emax
