#include "tests/benchmarks/features/plane_truth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "host/geometry/bounds.h"
#include "host/geometry/merge_vertices.h"
#include "tests/benchmarks/features/nearest_triangles.h"

namespace emax::benchmarks {
namespace {

constexpr double kSamePlane = 1e-5;  // of the width, and between unit normals
constexpr double kSmoothDegrees = 20;

double degrees_between(const Point& a, const Point& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) * 180 / std::numbers::pi;
}

bool is_same(const Plane& a, const Plane& b, double width) {
  return (a.normal - b.normal).norm() <= kSamePlane &&
         std::abs(a.offset - b.offset) <= kSamePlane * width;
}

// The number of the plane of each triangle, and the planes.
std::vector<std::uint32_t> planes_of_triangles(const TriangleMesh& mesh,
                                               std::vector<Plane>& planes) {
  const double width = bounds_of(mesh.vertices).width();
  std::vector<std::uint32_t> of(mesh.triangles.size(), PlaneTruth::kNone);
  for (std::size_t t = 0; t < of.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const Point cross = (b - a).cross(c - a);
    if (!(cross.norm() > 0)) continue;
    const Point normal = canonical_sign(cross.normalized());
    const Plane plane = {normal, normal.dot(a)};
    const auto same = std::ranges::find_if(
        planes, [&](const Plane& known) { return is_same(known, plane, width); });
    of[t] = static_cast<std::uint32_t>(same - planes.begin());
    if (same == planes.end()) planes.push_back(plane);
  }
  return of;
}

void drop_curved(const TriangleMesh& mesh, const std::vector<Plane>& planes,
                 std::vector<std::uint32_t>& of) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> edges;
  for (std::size_t t = 0; t < of.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges[std::minmax(a, b)].push_back(t);
    }
  }
  std::vector<bool> is_curved(of.size());
  for (const auto& [edge, triangles] : edges) {
    for (const std::size_t t : triangles) {
      for (const std::size_t u : triangles) {
        if (of[t] == of[u] || of[t] == PlaneTruth::kNone || of[u] == PlaneTruth::kNone) continue;
        if (degrees_between(planes[of[t]].normal, planes[of[u]].normal) < kSmoothDegrees) {
          is_curved[t] = true;
        }
      }
    }
  }
  for (bool spreads = true; spreads;) {  // over the other triangles of a facet
    spreads = false;
    for (const auto& [edge, triangles] : edges) {
      for (const std::size_t t : triangles) {
        for (const std::size_t u : triangles) {
          if (of[t] != of[u] || !is_curved[t] || is_curved[u]) continue;
          is_curved[u] = spreads = true;
        }
      }
    }
  }
  for (std::size_t t = 0; t < of.size(); ++t) {
    if (is_curved[t]) of[t] = PlaneTruth::kNone;
  }
}

}  // namespace

PlaneTruth truth_of(const TriangleMesh& given, std::span<const Point> cloud, double reach) {
  TriangleMesh mesh = given;
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  std::vector<Plane> planes;
  std::vector<std::uint32_t> of = planes_of_triangles(mesh, planes);
  drop_curved(mesh, planes, of);
  PlaneTruth truth;
  for (const Plane& plane : planes) truth.planes.push_back({plane, {}});
  truth.plane_of.assign(cloud.size(), PlaneTruth::kNone);
  const std::vector<NearestTriangle> nearest = nearest_triangles(cloud, mesh.view());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t plane = of[nearest[i].triangle];
    if (plane == PlaneTruth::kNone || nearest[i].distance > reach) continue;
    truth.plane_of[i] = plane;
    truth.planes[plane].points.push_back(i);
  }
  return truth;
}

PlaneScore score_of(const PlaneTruth& truth, std::span<const Point> cloud,
                    std::span<const FoundPlane> reported, std::size_t least) {
  PlaneScore score;
  score.reported = reported.size();
  std::vector<const FoundPlane*> match(truth.planes.size());
  for (const FoundPlane& plane : reported) {
    std::vector<std::size_t> shared(truth.planes.size());
    for (const std::uint32_t i : plane.points) {
      if (truth.plane_of[i] != PlaneTruth::kNone) ++shared[truth.plane_of[i]];
    }
    const auto most = std::ranges::max_element(shared);
    if (most == shared.end() || 2 * *most < plane.points.size()) {
      ++score.wrong;
      continue;
    }
    const auto known = static_cast<std::size_t>(most - shared.begin());
    if (2 * *most >= truth.planes[known].points.size()) match[known] = &plane;
  }
  for (std::size_t k = 0; k < truth.planes.size(); ++k) {
    const auto& [plane, points] = truth.planes[k];
    if (points.size() < least) continue;
    ++score.known;
    if (!match[k]) continue;
    ++score.found;
    Point middle = Point::Zero();
    for (const std::uint32_t i : points) middle += cloud[i] / static_cast<double>(points.size());
    middle -= plane.signed_distance(middle) * plane.normal;
    const double angle = degrees_between(plane.normal, match[k]->plane.normal);
    const double offset = std::abs(match[k]->plane.signed_distance(middle));
    score.greatest_angle = std::max(score.greatest_angle, angle);
    score.greatest_offset = std::max(score.greatest_offset, offset);
    score.mean_angle += angle;
    score.mean_offset += offset;
  }
  if (score.found > 0) {
    score.mean_angle /= static_cast<double>(score.found);
    score.mean_offset /= static_cast<double>(score.found);
  }
  return score;
}

}  // namespace emax::benchmarks
