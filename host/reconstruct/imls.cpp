// Implicit moving least squares (implicit_surface.h) as a reconstruction method.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/point_tree.h"
#include "host/parameters/registry.h"
#include "host/reconstruct/implicit_surface.h"
#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/reconstruction.h"

namespace emax {
namespace {

constexpr std::size_t kDensity = 10;  // the neighbour whose distance tells the density
constexpr double kSparsest = 4;       // of the median spacing; what is sparser is stray

constexpr double kBand = 0.8;        // of the reach
constexpr double kLeastCells = 2.5;  // marching cubes need the corners of a cube around each point
constexpr std::size_t kAround = 16;  // neighbours that a normal is compared with
constexpr int kRounds = 4;
constexpr float kAlike = 0.4f;  // difference of unit normals at which a neighbour counts e^-1/2

struct Around {
  std::vector<double> spacing;            // side of the square that each point has of the surface
  std::vector<std::uint32_t> neighbours;  // `count` of each point
  std::size_t count;
};

Around look_around(const LocalCloud& cloud) {
  std::vector<Point> points;
  points.reserve(cloud.size());
  for (const pcl::PointXYZ& p : *cloud.points()) {
    points.push_back(p.getVector3fMap().cast<double>());
  }
  const PointTree tree(points);
  Around around;
  around.count = std::min(kAround, points.size() - 1);
  around.spacing.reserve(points.size());
  around.neighbours.reserve(points.size() * around.count);
  std::vector<PointTree::Neighbour> near;
  for (const Point& p : points) {
    tree.nearest(p, around.count + 1, near);
    const std::size_t k = std::min(kDensity, around.count);
    around.spacing.push_back(
        std::sqrt(std::numbers::pi * near[k].squared_distance / static_cast<double>(k)));
    for (std::size_t i = 1; i <= around.count; ++i) around.neighbours.push_back(near[i].index);
  }
  return around;
}

// Normals are fitted across edges and so bend around them; means over neighbours whose normals are
// alike make them part there, and are less noisy elsewhere (bilateral filtering of normals).
void sharpen(std::vector<Eigen::Vector3f>& normals, const Around& around) {
  std::vector<Eigen::Vector3f> before;
  for (int round = 0; round < kRounds; ++round) {
    before = normals;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      Eigen::Vector3f sum = before[i];
      for (std::size_t k = 0; k < around.count; ++k) {
        const Eigen::Vector3f& n = before[around.neighbours[i * around.count + k]];
        sum += std::exp((n - before[i]).squaredNorm() / (-2 * kAlike * kAlike)) * n;
      }
      normals[i] = sum.normalized();
    }
  }
}

// Whether a point lies off the surface of its neighbours, by more than an edge or a corner does.
// `spread`: what noise alone may do.
bool is_stray(const LocalCloud& cloud, const std::vector<Eigen::Vector3f>& normals,
              const Around& around, std::size_t point, double spread) {
  constexpr double kOff = 1.5;  // spacings of the neighbours
  const auto neighbours = std::span(around.neighbours).subspan(point * around.count, around.count);
  Eigen::Vector3f mean = Eigen::Vector3f::Zero(), normal = mean;
  std::vector<double> spacings;
  for (const std::uint32_t n : neighbours) {
    mean += (*cloud.points())[n].getVector3fMap() / static_cast<float>(neighbours.size());
    normal += normals[n];
    spacings.push_back(around.spacing[n]);
  }
  std::ranges::sort(spacings);
  const Eigen::Vector3f offset = (*cloud.points())[point].getVector3fMap() - mean;
  const double off = std::abs(static_cast<double>(offset.dot(normal.normalized())));
  return off > kOff * spacings[spacings.size() / 2] + spread;
}

}  // namespace

Reconstruction Imls::run(const LocalCloud& cloud, const ParameterValues& values) {
  std::vector<Eigen::Vector3f> normals = cloud.oriented_normals(values);
  const Around around = look_around(cloud);
  sharpen(normals, around);
  std::vector<double> sorted = around.spacing;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double spacing = *middle, cell = values.at(kCell) * spacing;
  std::vector<OrientedPoint> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (is_stray(cloud, normals, around, i, values.at(kLeastReach) * spacing / 2)) continue;
    const double own = std::min(around.spacing[i], kSparsest * spacing);
    const double reach =
        std::max({values.at(kReach) * own, values.at(kLeastReach) * spacing, kLeastCells * cell});
    const double band = std::max(kBand * reach, kLeastCells * cell);
    points.push_back({(*cloud.points())[i].getVector3fMap(), normals[i], static_cast<float>(reach),
                      static_cast<float>(band), static_cast<float>(own * own)});
  }
  if (points.empty()) return {};
  ImplicitMesh mesh = implicit_surface(points, static_cast<float>(cell));
  Reconstruction result;
  result.mesh.vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices) result.mesh.vertices.push_back(cloud.world(v));
  result.mesh.triangles = std::move(mesh.triangles);
  return result;
}

}  // namespace emax
