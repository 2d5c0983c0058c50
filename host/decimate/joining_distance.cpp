#include "host/decimate/joining_distance.h"

#include <algorithm>
#include <cstddef>

#include "sw_model/certify/exact_distance.h"

namespace emax {
namespace {

constexpr std::size_t kMeasured = 50'000;
constexpr double kHalf = 0.5, kNearly = 0.9;
constexpr double kManyBeyondHalf = 0.02;

}  // namespace

JoiningDistance joining_distance(double within_half, double epsilon) {
  const double nearly = kNearly * epsilon;
  return {1 - within_half > kManyBeyondHalf ? nearly : kHalf * epsilon, nearly};
}

JoiningDistance joining_distance(const TriangleMesh& mesh, std::span<const Point> cloud,
                                 double epsilon, const std::function<bool()>& interrupted) {
  const double half = kHalf * epsilon;
  if (mesh.triangles.empty() || cloud.empty()) return joining_distance(1, epsilon);
  const std::vector<double> distances = sampled_distances(mesh, cloud, half, interrupted);
  if (distances.empty()) return joining_distance(1, epsilon);
  return joining_distance(1 - share_beyond(distances, half), epsilon);
}

std::vector<double> sampled_distances(const TriangleMesh& mesh, std::span<const Point> cloud,
                                      double enough, const std::function<bool()>& interrupted) {
  const ExactMesh exact(mesh.view());
  const std::size_t step = std::max<std::size_t>(1, (cloud.size() + kMeasured - 1) / kMeasured);
  std::vector<double> distances;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    if (interrupted && interrupted()) return {};
    distances.push_back(exact.nearest(cloud[i], enough).distance.upper);
  }
  return distances;
}

double share_beyond(std::span<const double> distances, double most) {
  const auto beyond = std::ranges::count_if(distances, [&](double d) { return d > most; });
  return static_cast<double>(beyond) / static_cast<double>(distances.size());
}

}  // namespace emax
