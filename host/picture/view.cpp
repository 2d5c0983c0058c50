#include "host/picture/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "host/geometry/bounds.h"
#include "host/picture/raster.h"

namespace emax {
namespace {

constexpr double kLowest = 0.03;        // of the extent: the points on which a thing stands
constexpr double kEyeDistance = 4;      // radii of the ball around what is looked at
constexpr int kDirections = 24;         // round the axis that is up
constexpr std::uint32_t kRaster = 160;  // pixels of a side, to compare directions
constexpr std::size_t kMostTriangles = 300'000;
constexpr double kBehind = 0.25;  // what a pixel counts that shows the inner side
constexpr double kFront = 0.1;    // what the front counts more, as a share

// The part of the bounding box across the axis over which the lowest points along it spread.
double footprint(std::span<const Point> points, const Bounds& box, Eigen::Index axis) {
  const Point extent = box.upper - box.lower;
  std::vector<Point> lowest;
  for (const Point& p : points) {
    if (p[axis] - box.lower[axis] <= kLowest * extent[axis]) lowest.push_back(p);
  }
  const Bounds foot = bounds_of(lowest);
  double part = 1;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (k != axis && extent[k] > 0) part *= (foot.upper[k] - foot.lower[k]) / extent[k];
  }
  return part;
}

// How far above the horizon the eye is, in radians: the flatter a thing, the higher.
double elevation(const Point& up, const Bounds& box) {
  const Point extent = box.upper - box.lower;
  const double height = extent.dot(up);
  const double breadth = (extent - height * up).maxCoeff();
  const double degrees = height < 0.15 * breadth ? 50 : height < 0.5 * breadth ? 30 : 15;
  return degrees * std::numbers::pi / 180;
}

// Up to kMostTriangles, evenly of all.
std::vector<std::array<Point, 3>> some_triangles(MeshView mesh) {
  std::vector<std::array<Point, 3>> some;
  const std::size_t count = std::min(mesh.triangles.size(), kMostTriangles);
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(mesh.corners(i * mesh.triangles.size() / count));
  }
  return some;
}

// The pixels that show the mesh.
double shown(const std::vector<std::array<Point, 3>>& triangles, const Camera& camera) {
  Raster raster(kRaster, 0, kRaster);
  for (const auto& v : triangles) {
    const auto a = camera.see(v[0]), b = camera.see(v[1]), c = camera.see(v[2]);
    if (!a || !b || !c) continue;
    const bool outer = (v[1] - v[0]).cross(v[2] - v[0]).dot(camera.eye() - v[0]) > 0;
    const std::uint8_t side = outer ? 1 : 2;
    raster.fill({*a, *b, *c}, [&](const auto&) { return Colour{side, 0, 0}; });
  }
  double sum = 0;
  for (const Sample& sample : raster.samples()) {
    sum += sample.colour[0] == 1 ? 1 : sample.colour[0] == 2 ? kBehind : 0;
  }
  return sum;
}

}  // namespace

Point up_of(std::span<const Point> points) {
  const Bounds box = bounds_of(points);
  const bool on_y = footprint(points, box, 1) > 2 * footprint(points, box, 2);
  return on_y ? Point::UnitY() : Point::UnitZ();
}

View view_of(MeshView mesh, std::span<const Point> points) {
  View best;
  best.up = up_of(points.empty() ? mesh.vertices : points);
  const Point front = best.up == Point::UnitY() ? Point::UnitZ() : Point(-Point::UnitY());
  const Point side = best.up.cross(front);
  const double above = elevation(best.up, bounds_of(mesh.vertices));
  const auto triangles = some_triangles(mesh);
  double most = -1;
  for (int i = 0; i < kDirections; ++i) {
    const double turn = 2 * std::numbers::pi * i / kDirections;
    View view = best;
    view.back = std::cos(above) * (std::cos(turn) * front + std::sin(turn) * side) +
                std::sin(above) * best.up;
    Camera camera(view, mesh.vertices);
    camera.fit_ball(kRaster);
    const double score = shown(triangles, camera) * (1 + kFront * std::cos(turn));
    if (score <= most) continue;
    most = score;
    best.back = view.back;
  }
  return best;
}

Camera::Camera(const View& view, std::span<const Point> at) : back_(view.back) {
  right_ = view.up.cross(back_).normalized();
  up_ = back_.cross(right_);
  const Bounds box = bounds_of(at);
  middle_ = box.midpoint();
  radius_ = (box.upper - middle_).norm();
  if (!(radius_ > 0)) radius_ = 1;  // a single place
  distance_ = kEyeDistance * radius_;
}

Camera::Ray Camera::ray(const Point& p) const {
  const Point from_middle = p - middle_;
  const double depth = distance_ - from_middle.dot(back_);
  return {from_middle.dot(right_) / depth, from_middle.dot(up_) / depth, depth};
}

void Camera::fit(std::span<const Point> at, double x, double y, double width, double height) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double left = kInfinity, right = -kInfinity, low = kInfinity, high = -kInfinity;
  for (const Point& p : at) {
    const Ray r = ray(p);
    left = std::min(left, r.u);
    right = std::max(right, r.u);
    low = std::min(low, r.v);
    high = std::max(high, r.v);
  }
  const double least = 1e-3;  // of the picture of a single place
  scale_ = std::min(width / std::max(right - left, least), height / std::max(high - low, least));
  shift_x_ = x + width / 2 - scale_ * (left + right) / 2;
  shift_y_ = y + height / 2 + scale_ * (low + high) / 2;
}

void Camera::fit_ball(double pixels) {
  // The ball's outline is seen under the angle whose sine is radius / distance.
  const double sine = radius_ / distance_;
  scale_ = pixels / 2 * std::sqrt(1 - sine * sine) / sine;
  shift_x_ = shift_y_ = pixels / 2;
}

std::optional<Seen> Camera::see(const Point& p) const {
  const Ray r = ray(p);
  if (!(r.depth > 0.1 * distance_)) return std::nullopt;
  return Seen{shift_x_ + scale_ * r.u, shift_y_ - scale_ * r.v, distance_ / r.depth};
}

double Camera::nearer(double nearness, double length) const {
  const double depth = distance_ / nearness;
  return distance_ / std::max(depth - length, depth / 2);
}

}  // namespace emax
