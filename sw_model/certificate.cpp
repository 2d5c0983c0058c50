#include "sw_model/certificate.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sw_model/error.h"
#include "sw_model/exact_distance.h"
#include "sw_model/flush_mode.h"

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

}  // namespace

CertifiedError certify(std::span<const Point> cloud, MeshView mesh,
                       std::span<const std::uint32_t> excluded) {
  require_no_flush("the certificate");
  const std::vector<bool> is_excluded = marked(cloud.size(), excluded);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!(cloud[i].array().abs() < 1e150).all()) {  // also for NaN
      throw Error("point " + std::to_string(i) +
                  " is not finite or beyond 1e150: nothing can be certified of it");
    }
  }

  CertifiedError result;
  result.points = cloud.size() - excluded.size();
  if (result.points == 0) throw Error("no point is left to certify: give a cloud, exclude less");

  const ExactMesh exact(mesh);
  std::uint32_t hint = 0;
  bool any = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (is_excluded[i]) continue;
    // A point with any triangle within the maximum so far cannot raise it, and one that only
    // equals it has the higher index.
    if (any && exact.distance_to(cloud[i], hint).upper <= result.e_max_upper) continue;
    const double enough = any ? result.e_max_upper : -1;
    const ExactMesh::Nearest nearest = exact.nearest(cloud[i], enough);
    hint = nearest.triangle;
    if (nearest.distance.upper <= enough) continue;
    any = true;
    result.e_max_upper = nearest.distance.upper;
    result.e_max_lower = std::max(result.e_max_lower, nearest.distance.lower);
    result.worst_point = i;
  }

  result.excluded.assign(excluded.begin(), excluded.end());
  result.e_max_upper_all = result.e_max_upper;
  for (const std::uint32_t index : excluded) {
    result.excluded_distances.push_back(exact.distance(cloud[index]).upper);
    result.e_max_upper_all = std::max(result.e_max_upper_all, result.excluded_distances.back());
  }
  return result;
}

}  // namespace emax
