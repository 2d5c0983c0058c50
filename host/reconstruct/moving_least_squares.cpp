#include "host/reconstruct/moving_least_squares.h"

#include <pcl/search/kdtree.h>
#include <pcl/surface/mls.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "host/reconstruct/local_cloud.h"

namespace emax {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

// The first point of every cell.
pcl::Indices one_of_each_cell(const Cloud& cloud, double cell) {
  std::map<std::array<double, 3>, pcl::index_t> first;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto at = [cell](float x) { return std::floor(static_cast<double>(x) / cell); };
    first.try_emplace({at(cloud[i].x), at(cloud[i].y), at(cloud[i].z)},
                      static_cast<pcl::index_t>(i));
  }
  pcl::Indices chosen;
  for (const auto& [key, index] : first) chosen.push_back(index);
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace

std::vector<Point> on_least_squares_surface(std::span<const Point> points,
                                            const ParameterValues& values) {
  const Mls::Method method = values.at(Mls::kMethod);
  if (method == Mls::Method::kNone) return {points.begin(), points.end()};
  const LocalCloud cloud(points);
  auto chosen = std::make_shared<pcl::Indices>(cloud.size());
  std::iota(chosen->begin(), chosen->end(), 0);
  if (method == Mls::Method::kResample) {
    *chosen = one_of_each_cell(*cloud.points(), values.at(Mls::kCell) * cloud.spacing());
  }
  pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointXYZ> mls;
  mls.setInputCloud(cloud.points());
  mls.setIndices(chosen);
  mls.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  mls.setSearchRadius(values.at(Mls::kRadius) * cloud.spacing());
  mls.setPolynomialOrder(values.at(Mls::kOrder));
  mls.setNumberOfThreads(1);
  Cloud projected;
  mls.process(projected);

  std::vector<Point> moved;
  moved.reserve(chosen->size());
  const pcl::Indices& of = mls.getCorrespondingIndices()->indices;
  std::size_t next = 0;
  for (const pcl::index_t i : *chosen) {
    const bool has =
        next < of.size() && of[next] == i && projected[next].getVector3fMap().allFinite();
    moved.push_back(has ? cloud.world(projected[next].getVector3fMap())
                        : cloud.original(static_cast<std::size_t>(i)));
    if (next < of.size() && of[next] == i) ++next;
  }
  return moved;
}

LeastSquaresPatch::LeastSquaresPatch(std::span<const Point> points, double radius)
    : points_(points.begin(), points.end()),
      origin_(Point::Zero()),
      scale_(1 / radius),
      radius_(1) {
  for (const Point& p : points_) origin_ += p / static_cast<double>(points_.size());
  for (Point& p : points_) p = (p - origin_) * scale_;
}

Point LeastSquaresPatch::project(const Point& point) const {
  // PCL fits no polynomial to fewer points than it has coefficients, but would look at it.
  constexpr std::size_t kQuadratic = 6;
  const int order = points_.size() < kQuadratic ? 1 : 2;
  Cloud cloud;
  for (const Point& p : points_) {
    cloud.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  const Point at = (point - origin_) * scale_;
  cloud.push_back(
      {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
  pcl::Indices neighbours(points_.size());
  std::iota(neighbours.begin(), neighbours.end(), 0);
  pcl::MLSResult surface;
  surface.computeMLSSurface(cloud, static_cast<pcl::index_t>(points_.size()), neighbours, radius_,
                            order);
  if (!surface.valid) return point;
  const Point projected = surface.projectQueryPoint(pcl::MLSResult::SIMPLE).point;
  return projected.allFinite() ? Point(projected / scale_ + origin_) : point;
}

}  // namespace emax
