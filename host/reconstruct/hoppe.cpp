// Marching cubes on the signed distance to tangent planes (paper, section 2.1 and [1]) through PCL.
#include <pcl/search/kdtree.h>
#include <pcl/surface/marching_cubes_hoppe.h>
#include <pcl/surface/impl/marching_cubes.hpp>
#include <pcl/surface/impl/marching_cubes_hoppe.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "host/parameters/registry.h"
#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/reconstruction.h"

namespace emax {
namespace {

// Neighbouring cells calculate the vertex on their common edge each for itself, some units of
// binary32 apart (6e-6 of the smallest cell); anything farther apart is meant.
constexpr float kWeldTolerance = 1e-4f;  // of the cell's side

// PCL's grid has equal numbers of cells along all axes and its box cannot be set: a flat cloud
// would get flat cells. This one's cells are cubes and leave two rows of margin.
class CubicMarching : public pcl::MarchingCubesHoppe<pcl::PointNormal> {
 public:
  CubicMarching(const Eigen::AlignedBox3f& box, int resolution, double reach)
      : cell_(box.sizes().maxCoeff() / static_cast<float>(resolution)) {
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(2 * cell_);
    low_ = box.min() - margin;
    // The last node that PCL contours is the one before the last.
    cells_ = ((box.sizes() + 2 * margin) / cell_).array().ceil().cast<int>() + 2;
    setGridResolution(cells_.x(), cells_.y(), cells_.z());
    setPercentageExtendGrid(0);
    setIsoLevel(0);
    reach_ = static_cast<float>(reach);
  }
  float cell() const { return cell_; }
  void set_spacing(double spacing) {
    const double diagonal = static_cast<double>(cell_) * std::numbers::sqrt3;
    const double distance = static_cast<double>(reach_) * (diagonal + spacing);
    setDistanceIgnore(static_cast<float>(distance * distance));  // compared with a squared distance
  }

 protected:
  void voxelizeData() override {
    lower_boundary_ = low_.array();
    size_voxel_ = Eigen::Array3f::Constant(cell_);
    upper_boundary_ = lower_boundary_ + size_voxel_ * cells_.cast<float>();
    MarchingCubesHoppe::voxelizeData();
  }

 private:
  float cell_;
  float reach_;
  Eigen::Vector3f low_;
  Eigen::Array3i cells_;
};

// One index for all points within a tolerance of the first of them.
class Weld {
 public:
  explicit Weld(float tolerance) : tolerance_(tolerance) {}

  std::uint32_t index_of(const Eigen::Vector3f& p) {
    const Eigen::Array3i home = (p / (2 * tolerance_)).array().floor().cast<int>();
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const Eigen::Array3i offset(neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1);
      const auto [first, last] = buckets_.equal_range(hash(home + offset));
      for (auto at = first; at != last; ++at) {
        if ((points_[at->second] - p).norm() <= tolerance_) return at->second;
      }
    }
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    buckets_.emplace(hash(home), index);
    return index;
  }
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  static std::uint64_t hash(const Eigen::Array3i& bucket) {
    const auto word = [&](int axis) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(bucket[axis]));
    };
    return word(0) * 0x9e3779b97f4a7c15u ^ word(1) * 0xc2b2ae3d27d4eb4fu ^
           word(2) * 0x165667b19e3779f9u;
  }

  float tolerance_;
  std::vector<Eigen::Vector3f> points_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> buckets_;
};

}  // namespace

Reconstruction Hoppe::run(const LocalCloud& cloud, const ParameterValues& values,
                          std::size_t threads) {
  Eigen::AlignedBox3f box;
  for (const pcl::PointXYZ& p : *cloud.points()) box.extend(Eigen::Vector3f(p.getVector3fMap()));
  CubicMarching marching(box, values.at(kResolution), values.at(kReach));
  marching.set_spacing(cloud.spacing());
  marching.setInputCloud(cloud.with_normals(values, threads));
  marching.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  pcl::PointCloud<pcl::PointNormal> soup;
  std::vector<pcl::Vertices> polygons;
  marching.reconstruct(soup, polygons);

  Reconstruction result;
  Weld weld(kWeldTolerance * marching.cell());
  result.mesh.triangles.reserve(polygons.size());
  for (const pcl::Vertices& polygon : polygons) {
    Triangle& t = result.mesh.triangles.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto at = static_cast<std::size_t>(polygon.vertices[corner]);
      t[corner] = weld.index_of(soup[at].getVector3fMap());
    }
  }
  result.mesh.vertices.reserve(weld.points().size());
  for (const Eigen::Vector3f& p : weld.points()) result.mesh.vertices.push_back(cloud.world(p));
  return result;
}

}  // namespace emax
