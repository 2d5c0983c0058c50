#include "host/features/find_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/features/neighbourhoods.h"
#include "host/features/outline.h"
#include "host/features/plane_detection.h"
#include "host/features/plane_fit.h"
#include "host/features/sample_consensus.h"
#include "host/geometry/bounds.h"

namespace emax {
namespace {

// The points around the origin, each once, and for each point of the cloud the number of its place.
struct DistinctPoints {
  std::vector<Point> points;
  std::vector<std::uint32_t> place;
};

DistinctPoints distinct(std::span<const Point> cloud, const Point& origin) {
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    return std::tuple(cloud[i].x(), cloud[i].y(), cloud[i].z());
  };
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(key(a), a) < std::pair(key(b), b);
  });
  std::vector<std::uint32_t> first(cloud.size());  // of those that coincide
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && cloud[order[i]] == cloud[order[i - 1]];
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  DistinctPoints found;
  found.place.resize(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (first[i] == i) {
      found.place[i] = static_cast<std::uint32_t>(found.points.size());
      found.points.push_back(cloud[i] - origin);
    } else {
      found.place[i] = found.place[first[i]];
    }
  }
  return found;
}

void set_outline(Region& region, const Plane& plane, std::span<const Point> points) {
  const FittedPlane axes = fit_plane(points, region.points);
  const Point u = (axes.along - axes.along.dot(plane.normal) * plane.normal).normalized();
  const Point v = plane.normal.cross(u);
  std::vector<Eigen::Vector2d> flat;
  for (const std::uint32_t i : region.points) flat.emplace_back(u.dot(points[i]), v.dot(points[i]));
  const Outline outline = outline_of(flat);
  region.area = outline.area;
  for (const Eigen::Vector2d& p : outline.polygon) {
    region.outline.emplace_back(p.x() * u + p.y() * v + plane.offset * plane.normal);
  }
}

// The cylinder is cut where its points leave the widest gap, and unrolled.
void set_outline(Region& region, const Cylinder& cylinder, std::span<const Point> points) {
  const Point u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
  std::vector<double> angles;
  for (const std::uint32_t i : region.points) {
    const Point outward = cylinder.outward(points[i]);
    angles.push_back(std::atan2(v.dot(outward), u.dot(outward)));
  }
  std::vector<double> sorted = angles;
  std::ranges::sort(sorted);
  double cut = sorted.front(), widest = cut + 2 * std::numbers::pi - sorted.back();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[i - 1] > widest) widest = sorted[i] - sorted[i - 1], cut = sorted[i];
  }
  std::vector<Eigen::Vector2d> flat;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double turned = angles[i] < cut ? angles[i] + 2 * std::numbers::pi : angles[i];
    flat.emplace_back(cylinder.radius * turned,
                      cylinder.axis.dot(points[region.points[i]] - cylinder.centre));
  }
  const Outline outline = outline_of(flat);
  region.area = outline.area;
  for (const Eigen::Vector2d& p : outline.polygon) {
    const double angle = p.x() / cylinder.radius;
    region.outline.emplace_back(cylinder.centre + p.y() * cylinder.axis +
                                cylinder.radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
}

// The cap about the mean direction that holds the points; it has no outline.
void set_outline(Region& region, const Sphere& sphere, std::span<const Point> points) {
  Point mean = Point::Zero();
  for (const std::uint32_t i : region.points) mean += sphere.normal_at(points[i]);
  mean.stableNormalize();
  double least = 1;
  for (const std::uint32_t i : region.points) {
    least = std::min(least, mean.dot(sphere.normal_at(points[i])));
  }
  region.area = 2 * std::numbers::pi * sphere.radius * sphere.radius * (1 - least);
}

struct MoveBy {
  Point origin;
  void operator()(Plane& plane) const { plane.offset += plane.normal.dot(origin); }
  void operator()(Cylinder& cylinder) const { cylinder.centre += origin; }
  void operator()(Sphere& sphere) const { sphere.centre += origin; }
};

// Of the cloud, from those of the distinct points.
void to_cloud(std::vector<Region>& regions, const DistinctPoints& distinct, const Point& origin) {
  std::vector<std::uint32_t> owner(distinct.points.size(), kNoRegion);
  for (std::uint32_t r = 0; r < regions.size(); ++r) {
    for (const std::uint32_t i : regions[r].points) owner[i] = r;
    regions[r].points.clear();
    for (Point& corner : regions[r].outline) corner += origin;
    std::visit(MoveBy{origin}, regions[r].shape);
  }
  for (std::uint32_t i = 0; i < distinct.place.size(); ++i) {
    const std::uint32_t r = owner[distinct.place[i]];
    if (r != kNoRegion) regions[r].points.push_back(i);
  }
}

}  // namespace

Features find_features(std::span<const Point> cloud, const FeatureSearch& search) {
  constexpr std::size_t kFewestPoints = 8;  // that anything is told from
  Features found;
  FeatureOptions& options = found.options;
  options.least_support = std::max(search.least_support, kFewestPoints);
  options.seed = search.seed;
  options.threads = search.threads;
  options.check = search.check;
  if (cloud.size() < options.least_support) return found;
  const Point origin = bounds_of(cloud).midpoint();
  const DistinctPoints distinct_points = distinct(cloud, origin);
  const std::span<const Point> points = distinct_points.points;
  const PointTree tree(points);
  const ScanEstimate scan = estimate_scan(points, tree);
  const std::optional<double> band =
      search.max_error ? search.max_error : suggested_tolerance(scan);
  if (!band || points.size() < options.least_support) return found;
  options.band = *band;
  options.noise = std::min(scan.noise, *band);
  options.spacing = scan.spacing;
  const Neighbourhoods near = neighbourhoods_of(points, tree, options.neighbours, options.angle,
                                                options.noise, options.threads, options.check);
  found.regions = search.planes == PlaneMethod::kHough ? hough_planes(points, near, options)
                                                       : grow_planes(points, near, options);
  if (search.curved) {
    std::vector<Region> curved = find_curved(points, near, options, found.regions);
    std::ranges::move(curved, std::back_inserter(found.regions));
  }
  for (Region& region : found.regions) {
    std::visit([&](const auto& shape) { set_outline(region, shape, points); }, region.shape);
  }
  to_cloud(found.regions, distinct_points, origin);
  std::ranges::sort(found.regions, [](const Region& a, const Region& b) {
    return a.points.size() != b.points.size() ? a.points.size() > b.points.size()
                                              : a.points.front() < b.points.front();
  });
  return found;
}

}  // namespace emax
