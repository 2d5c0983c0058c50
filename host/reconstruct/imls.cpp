// Implicit moving least squares (implicit_surface.h) as a reconstruction method.
#include "host/reconstruct/imls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/point_tree.h"
#include "host/parameters/registry.h"
#include "host/reconstruct/reconstruction.h"
#include "sw_model/base/parallel.h"

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

double spacing_at(const std::vector<PointTree::Neighbour>& near, std::size_t k) {
  return std::sqrt(std::numbers::pi * near[k].squared_distance / static_cast<double>(k));
}

Around look_around(const LocalCloud& cloud, std::size_t threads) {
  std::vector<Point> points;
  points.reserve(cloud.size());
  for (const pcl::PointXYZ& p : *cloud.points()) {
    points.push_back(p.getVector3fMap().cast<double>());
  }
  const PointTree tree(points);
  Around around;
  around.count = std::min(kAround, points.size() - 1);
  around.spacing.resize(points.size());
  around.neighbours.resize(points.size() * around.count);
  const std::size_t k = std::min(kDensity, around.count);
  in_pieces(threads, points.size(), kPointsAtATime,
            [&](std::size_t, std::size_t first, std::size_t last) {
              std::vector<PointTree::Neighbour> near;
              for (std::size_t p = first; p < last; ++p) {
                tree.nearest(points[p], around.count + 1, near);
                around.spacing[p] = spacing_at(near, k);
                for (std::size_t i = 0; i < around.count; ++i) {
                  around.neighbours[p * around.count + i] = near[i + 1].index;
                }
              }
            });
  return around;
}

// Normals are fitted across edges and so bend around them; means over neighbours whose normals are
// alike make them part there, and are less noisy elsewhere (bilateral filtering of normals).
void sharpen(std::vector<Eigen::Vector3f>& normals, const Around& around, std::size_t threads) {
  std::vector<Eigen::Vector3f> before;
  for (int round = 0; round < kRounds; ++round) {
    before = normals;
    in_pieces(threads, normals.size(), kPointsAtATime,
              [&](std::size_t, std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) {
                  Eigen::Vector3f sum = before[i];
                  for (std::size_t k = 0; k < around.count; ++k) {
                    const Eigen::Vector3f& n = before[around.neighbours[i * around.count + k]];
                    sum += std::exp((n - before[i]).squaredNorm() / (-2 * kAlike * kAlike)) * n;
                  }
                  normals[i] = sum.normalized();
                }
              });
  }
}

// How much farther a point lies off the surface of its neighbours than an edge or a corner does.
double off_neighbours(const LocalCloud& cloud, const std::vector<Eigen::Vector3f>& normals,
                      const Around& around, std::size_t point) {
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
  return off - kOff * spacings[spacings.size() / 2];
}

}  // namespace

std::vector<double> spacings_of_some(std::span<const Point> points,
                                     const Normalization& normalization, std::size_t samples) {
  std::vector<Point> normalised;
  for (const Point& p : points) {
    normalised.push_back(normalization.apply(p).cast<float>().cast<double>());
  }
  std::vector<double> spacings;
  if (normalised.size() < 3) return spacings;
  const PointTree tree(normalised);
  const std::size_t k = std::min(kDensity, normalised.size() - 1);
  std::vector<PointTree::Neighbour> near;
  const std::size_t step = std::max<std::size_t>(1, normalised.size() / samples);
  for (std::size_t p = 0; p < normalised.size(); p += step) {
    tree.nearest(normalised[p], k + 1, near);
    spacings.push_back(spacing_at(near, k));
  }
  return spacings;
}

SampledCloud sample(const LocalCloud& cloud, const ParameterValues& values, std::size_t threads) {
  OrientedNormals oriented = cloud.oriented_normals(values, threads);
  const Around around = look_around(cloud, threads);
  SampledCloud sampled{std::vector<SampledPoint>(cloud.size()), oriented.normals,
                       std::move(oriented.part)};
  sharpen(oriented.normals, around, threads);
  in_pieces(threads, cloud.size(), kPointsAtATime,
            [&](std::size_t, std::size_t first, std::size_t last) {
              for (std::size_t i = first; i < last; ++i) {
                sampled.points[i] = {(*cloud.points())[i].getVector3fMap(), oriented.normals[i],
                                     around.spacing[i],
                                     off_neighbours(cloud, oriented.normals, around, i)};
              }
            });
  return sampled;
}

PointShape::PointShape(const ParameterValues& values, double spacing)
    : spacing_(spacing),
      cell_(values.at(Imls::kCell) * spacing),
      reach_(values.at(Imls::kReach)),
      least_reach_(values.at(Imls::kLeastReach) * spacing) {}

std::optional<OrientedPoint> PointShape::operator()(const SampledPoint& point) const {
  if (point.off > least_reach_ / 2) return std::nullopt;  // by more than noise may do
  const double own = std::min(point.spacing, kSparsest * spacing_);
  const double reach = std::max({reach_ * own, least_reach_, kLeastCells * cell_});
  const double band = std::max(kBand * reach, kLeastCells * cell_);
  return OrientedPoint{point.position, point.normal, static_cast<float>(reach),
                       static_cast<float>(band), static_cast<float>(own * own)};
}

Reconstruction Imls::run(const LocalCloud& cloud, const ParameterValues& values,
                         std::size_t threads) {
  const SampledCloud sampled = sample(cloud, values, threads);
  std::vector<double> spacings;
  for (const SampledPoint& p : sampled.points) spacings.push_back(p.spacing);
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::ranges::nth_element(spacings, middle);
  const PointShape shape(values, *middle);
  std::vector<OrientedPoint> points;
  points.reserve(cloud.size());
  Eigen::AlignedBox3f box;
  float reach = 0;
  for (const SampledPoint& p : sampled.points) {
    const std::optional<OrientedPoint> point = shape(p);
    if (!point) continue;
    points.push_back(*point);
    box.extend(point->position);
    reach = std::max(reach, point->reach);
  }
  if (points.empty()) return {};
  ImplicitMesh mesh = implicit_surface(points, Lattice(box.min(), box.max(), reach, shape.cell()));
  Reconstruction result;
  result.mesh.vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices)
    result.mesh.vertices.push_back(cloud.normalization().invert(v));
  result.mesh.triangles = std::move(mesh.triangles);
  return result;
}

}  // namespace emax
