#include "sw_model/certify/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/base/morton.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

std::vector<bool> marked(std::size_t points, std::span<const std::uint32_t> excluded) {
  std::vector<bool> is_excluded(points, false);
  for (const std::uint32_t index : excluded) {
    if (index >= points || is_excluded[index]) {
      throw std::invalid_argument("excluded point " + std::to_string(index) +
                                  " does not exist or comes twice");
    }
    is_excluded[index] = true;
  }
  return is_excluded;
}

void require_finite(std::span<const Point> cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!(cloud[i].array().abs() < 1e150).all()) {  // also for NaN
      throw Error("point " + std::to_string(i) +
                  " is not finite or beyond 1e150: nothing can be certified of it");
    }
  }
}

// The kept points along a Morton curve. Any order gives the same certificate.
std::vector<std::uint32_t> along_a_curve(std::span<const Point> cloud,
                                         const std::vector<bool>& is_excluded) {
  Point low = cloud.front(), high = low;
  for (const Point& p : cloud) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr double kCells = 1023;  // on each axis; the greatest coordinate has a cell of its own
  const double width = (high - low).maxCoeff();
  const double scale = width > 0 ? kCells / width : 0;
  std::vector<std::uint64_t> keys;
  keys.reserve(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (is_excluded[i]) continue;
    std::uint64_t code = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double cell = std::clamp((cloud[i][k] - low[k]) * scale, 0.0, kCells);
      code = code << 1 | spread_bits(static_cast<std::uint64_t>(cell));
    }
    keys.push_back(code << 32 | i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const std::uint64_t key : keys) order.push_back(static_cast<std::uint32_t>(key));
  return order;
}

// The greatest distance so far, and the lowest index of a point that has it.
struct Worst {
  double upper = -1;
  std::size_t point = std::numeric_limits<std::size_t>::max();

  void raise(double distance, std::size_t at) {
    if (distance < upper || (distance == upper && at > point)) return;
    upper = distance;
    point = at;
  }
  // A point with any triangle within this cannot be the worst.
  double enough(std::size_t at) const {
    return at > point ? upper : std::nextafter(upper, -std::numeric_limits<double>::infinity());
  }
};

constexpr std::size_t kPiece = 4096;  // points

Worst worst_of(std::span<const Point> cloud, std::span<const std::uint32_t> order,
               const ExactMesh& mesh, std::size_t threads) {
  Worst worst;
  std::mutex mutex;
  in_pieces(threads, order.size(), kPiece, [&](std::size_t, std::size_t first, std::size_t last) {
    Worst mine;
    {
      const std::lock_guard lock(mutex);
      mine = worst;
    }
    std::optional<std::uint32_t> near;
    for (const std::uint32_t i : order.subspan(first, last - first)) {
      const double enough = mine.enough(i);
      if (near && mesh.is_within(cloud[i], *near, enough)) continue;
      const ExactMesh::Nearest nearest = mesh.nearest(cloud[i], enough, near.value_or(~0u));
      near = nearest.triangle;
      if (nearest.distance.upper > enough) mine.raise(nearest.distance.upper, i);
    }
    const std::lock_guard lock(mutex);
    worst.raise(mine.upper, mine.point);
  });
  return worst;
}

}  // namespace

CertifiedError certify(std::span<const Point> cloud, const ExactMesh& mesh,
                       std::span<const std::uint32_t> excluded, std::size_t threads) {
  require_no_flush("the certificate");
  const std::vector<bool> is_excluded = marked(cloud.size(), excluded);
  require_finite(cloud);
  CertifiedError result;
  result.points = cloud.size() - excluded.size();
  if (result.points == 0) throw Error("no point is left to certify: give a cloud, exclude less");

  result.worst_point = worst_of(cloud, along_a_curve(cloud, is_excluded), mesh, threads).point;
  // Computed once more without a seed: the lower end depends on the triangles that a search met.
  const DistanceBounds distance = mesh.distance(cloud[result.worst_point]);
  result.e_max_upper = distance.upper;
  result.e_max_lower = distance.lower;

  result.excluded.assign(excluded.begin(), excluded.end());
  result.e_max_upper_all = result.e_max_upper;
  for (const std::uint32_t index : excluded) {
    result.excluded_distances.push_back(mesh.distance(cloud[index]).upper);
    result.e_max_upper_all = std::max(result.e_max_upper_all, result.excluded_distances.back());
  }
  return result;
}

CertifiedError certify(std::span<const Point> cloud, MeshView mesh,
                       std::span<const std::uint32_t> excluded, std::size_t threads) {
  require_no_flush("the certificate");
  require_finite(cloud);
  return certify(cloud, ExactMesh(mesh), excluded, threads);
}

}  // namespace emax
