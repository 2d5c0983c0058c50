#include "host/reconstruct/local_cloud.h"

#include <pcl/common/centroid.h>
#include <pcl/features/normal_3d.h>
#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include "host/parameters/registry.h"
#include "host/reconstruct/orient_normals.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

// Of each point from its nearest neighbour, squared.
std::vector<float> squared_spacings(const pcl::KdTreeFLANN<pcl::PointXYZ>& tree,
                                    const pcl::PointCloud<pcl::PointXYZ>& points) {
  std::vector<float> squared(points.size());
  pcl::Indices indices(2);
  std::vector<float> squared_distances(2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.nearestKSearch(points[i], 2, indices, squared_distances);
    squared[i] = squared_distances[1];
  }
  return squared;
}

// Those that stand in the middle between their nearest neighbour and another point.
std::size_t points_amid_lines(const pcl::KdTreeFLANN<pcl::PointXYZ>& tree,
                              const pcl::PointCloud<pcl::PointXYZ>& points) {
  std::size_t count = 0;
  pcl::Indices indices(2);
  std::vector<float> squared_distances(2);
  for (const pcl::PointXYZ& p : points) {
    tree.nearestKSearch(p, 2, indices, squared_distances);
    const float squared = squared_distances[1];
    pcl::PointXYZ opposite;
    opposite.getVector3fMap() =
        2 * p.getVector3fMap() - points[static_cast<std::size_t>(indices[1])].getVector3fMap();
    tree.nearestKSearch(opposite, 1, indices, squared_distances);
    count += squared_distances[0] <= 1e-6f * squared ? 1 : 0;
    indices.resize(2);
    squared_distances.resize(2);
  }
  return count;
}

bool is_tenth(std::size_t part, std::size_t whole) { return 10 * part >= whole; }

}  // namespace

LocalCloud::LocalCloud(std::span<const Point> points)
    : LocalCloud(points, points.empty() ? Normalization{} : normalization_of(points)) {}

LocalCloud::LocalCloud(std::span<const Point> points, const Normalization& normalization)
    : source_(points), normalization_(normalization), points_(new pcl::PointCloud<pcl::PointXYZ>) {
  if (points.size() < 3) {
    throw Error("the cloud has only " + std::to_string(points.size()) +
                " points; a surface needs at least three");
  }
  std::vector<Eigen::Vector3f> local(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    local[i] = normalization_.apply(points[i]).cast<float>();
  }
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    return std::array<float, 3>{local[i].x(), local[i].y(), local[i].z()};
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  std::vector<std::uint32_t> count(points.size(), 0);  // at the first of equal points
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (key(order[i]) != key(order[first])) first = i;
    ++count[order[first]];
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (count[i] == 0) continue;
    points_->push_back({local[i].x(), local[i].y(), local[i].z()});
    first_.push_back(i);
    multiplicity_.push_back(count[i]);
  }
  if (size() < 3) {
    throw Error("the cloud has only " + std::to_string(size()) +
                " distinct points; a surface needs at least three");
  }
}

const LocalCloud::Look& LocalCloud::looked_at() const {
  if (look_) return *look_;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(points_);
  std::vector<float> squared = squared_spacings(tree, *points_);
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  const float median = *middle;
  const auto at_median = std::ranges::count_if(
      squared, [median](float s) { return std::abs(s - median) <= 2e-4f * median; });
  const bool is_regular = is_tenth(static_cast<std::size_t>(at_median), size()) &&
                          is_tenth(points_amid_lines(tree, *points_), size());
  return look_.emplace(Look{std::sqrt(static_cast<double>(median)), is_regular});
}

OrientedNormals LocalCloud::oriented_normals(const ParameterValues& values,
                                             std::size_t threads) const {
  const int n = static_cast<int>(size());
  const auto k = static_cast<std::size_t>(std::clamp(values.at(Normals::kNeighbours), 3, n));
  const auto graph_k =
      static_cast<std::size_t>(std::clamp(values.at(Normals::kOrientationNeighbours), 2, n));
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(points_);
  std::vector<Eigen::Vector3f> positions(size());
  OrientedNormals result;
  result.normals.resize(size());
  std::vector<std::uint32_t> neighbours(size() * graph_k);
  in_pieces(threads, size(), kPointsAtATime, [&](std::size_t, std::size_t first, std::size_t last) {
    pcl::Indices indices;
    std::vector<float> squared_distances;
    for (std::size_t i = first; i < last; ++i) {
      tree.nearestKSearch((*points_)[i], static_cast<unsigned>(std::max(k, graph_k)), indices,
                          squared_distances);
      for (std::size_t j = 0; j < graph_k; ++j) {
        neighbours[i * graph_k + j] = static_cast<std::uint32_t>(indices[j]);
      }
      indices.resize(k);
      Eigen::Vector4f plane;
      float curvature;
      pcl::computePointNormal(*points_, indices, plane, curvature);
      positions[i] = (*points_)[i].getVector3fMap();
      const float length = plane.head<3>().norm();
      result.normals[i] = std::isfinite(length) && length > 0
                              ? Eigen::Vector3f(plane.head<3>() / length)
                              : Eigen::Vector3f(0, 0, 1);
    }
  });
  result.part = orient_normals(positions, neighbours, graph_k, result.normals);
  return result;
}

pcl::PointCloud<pcl::PointNormal>::Ptr LocalCloud::with_normals(const ParameterValues& values,
                                                                std::size_t threads) const {
  const std::vector<Eigen::Vector3f> normals = oriented_normals(values, threads).normals;
  const auto cloud = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  cloud->resize(size());
  for (std::size_t i = 0; i < size(); ++i) {
    (*cloud)[i].getVector3fMap() = (*points_)[i].getVector3fMap();
    (*cloud)[i].getNormalVector3fMap() = normals[i];
  }
  return cloud;
}

}  // namespace emax
