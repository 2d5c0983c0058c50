// CGAL is GPL: a peer of these measurements, linked into nothing else.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Shape_detection/Efficient_RANSAC.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/property_map.h>

#include <cmath>
#include <tuple>

#include "host/features/plane_fit.h"
#include "tests/benchmarks/features/plane_tools.h"

namespace emax::benchmarks {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
// The RANSAC changes the order of its input, so a point keeps its number.
using Oriented = std::tuple<Kernel::Point_3, Kernel::Vector_3, std::uint32_t>;
using OrientedPoints = std::vector<Oriented>;
using PointMap = CGAL::Nth_of_tuple_property_map<0, Oriented>;
using NormalMap = CGAL::Nth_of_tuple_property_map<1, Oriented>;
namespace shapes = CGAL::Shape_detection;

constexpr unsigned kNeighbours = 16;  // as emax takes
constexpr double kDegrees = 20;       // of its normals, likewise

OrientedPoints oriented_points(std::span<const Point> cloud) {
  OrientedPoints points;
  for (const Point& p : cloud) {
    points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), CGAL::NULL_VECTOR,
                        static_cast<std::uint32_t>(points.size()));
  }
  CGAL::pca_estimate_normals<CGAL::Sequential_tag>(
      points, kNeighbours, CGAL::parameters::point_map(PointMap()).normal_map(NormalMap()));
  return points;
}

FoundPlane fitted(std::span<const Point> cloud, std::vector<std::uint32_t> members) {
  const Plane plane = fit_plane(cloud, members).plane;
  return {plane, std::move(members)};
}

}  // namespace

std::vector<FoundPlane> planes_of_cgal_ransac(const PlaneTask& task) {
  using Traits = shapes::Efficient_RANSAC_traits<Kernel, OrientedPoints, PointMap, NormalMap>;
  OrientedPoints points = oriented_points(task.cloud);
  CGAL::get_default_random() = CGAL::Random(static_cast<unsigned>(task.seed));
  shapes::Efficient_RANSAC<Traits> ransac;
  ransac.set_input(points);
  ransac.add_shape_factory<shapes::Plane<Traits>>();
  ransac.add_shape_factory<shapes::Cylinder<Traits>>();
  shapes::Efficient_RANSAC<Traits>::Parameters parameters;
  parameters.min_points = task.least_support;
  parameters.epsilon = task.band;
  parameters.normal_threshold = std::cos(kDegrees * CGAL_PI / 180);
  ransac.detect(parameters);
  std::vector<FoundPlane> found;
  for (const auto& shape : ransac.shapes()) {
    if (!dynamic_cast<shapes::Plane<Traits>*>(shape.get())) continue;
    std::vector<std::uint32_t> members;
    for (const std::size_t i : shape->indices_of_assigned_points()) {
      members.push_back(std::get<2>(points[i]));
    }
    found.push_back(fitted(task.cloud, std::move(members)));
  }
  return found;
}

std::vector<FoundPlane> planes_of_cgal_growing(const PlaneTask& task) {
  using Neighbours = shapes::Point_set::K_neighbor_query<Kernel, OrientedPoints, PointMap>;
  using Region = shapes::Point_set::Least_squares_plane_fit_region<Kernel, OrientedPoints, PointMap,
                                                                   NormalMap>;
  using Order = shapes::Point_set::Least_squares_plane_fit_sorting<Kernel, OrientedPoints,
                                                                   Neighbours, PointMap>;
  const OrientedPoints points = oriented_points(task.cloud);
  Neighbours neighbours(points, kNeighbours);
  Region region(points, task.band, kDegrees, task.least_support);
  Order order(points, neighbours);
  order.sort();
  shapes::Region_growing<OrientedPoints, Neighbours, Region, Order::Seed_map> growing(
      points, neighbours, region, order.seed_map());
  std::vector<std::vector<std::size_t>> regions;
  growing.detect(std::back_inserter(regions));
  std::vector<FoundPlane> found;
  for (const std::vector<std::size_t>& members : regions) {
    std::vector<std::uint32_t> numbers;
    for (const std::size_t i : members) numbers.push_back(static_cast<std::uint32_t>(i));
    found.push_back(fitted(task.cloud, std::move(numbers)));
  }
  return found;
}

}  // namespace emax::benchmarks
