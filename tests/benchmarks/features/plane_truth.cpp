#include "tests/benchmarks/features/plane_truth.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "host/features/plane_fit.h"
#include "host/geometry/bounds.h"
#include "host/geometry/merge_vertices.h"
#include "tests/benchmarks/features/nearest_triangles.h"

namespace emax::benchmarks {
namespace {

constexpr double kFacetDegrees = 2;  // a triangle's own normal may be off by more than its facet's
constexpr double kSmoothDegrees = 20;   // across an edge of a curved surface
constexpr double kFlatRadians = 0.003;  // a facet that turns by more from end to end is curved

double degrees_between(const Point& a, const Point& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) * 180 / std::numbers::pi;
}

// Connected triangles on one plane.
struct Facet {
  std::vector<std::uint32_t> triangles;
  FittedPlane fitted;  // to the corners
  bool is_curved = false;
};

// Cuts a mesh into facets, the one around the largest triangle first.
class Facets {
 public:
  Facets(const TriangleMesh& mesh, double flatness) : mesh_(mesh), flatness_(flatness) {
    find_neighbours();
    for (const std::uint32_t t : by_area()) {
      if (facet_of_[t] == PlaneTruth::kNone) grow(t);
    }
    for (std::uint32_t f = 0; f < facets_.size(); ++f) facets_[f].is_curved = is_curved(f);
  }

  const std::vector<Facet>& all() const { return facets_; }

  // Whether all corners of a facet lie on a plane of about its direction.
  bool lies_on(const Facet& facet, const Plane& plane) const {
    return degrees_between(facet.fitted.plane.normal, plane.normal) <= kFacetDegrees &&
           std::ranges::all_of(facet.triangles, [&](auto t) { return is_near(t, plane); });
  }

 private:
  void find_neighbours() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        edges[std::minmax(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3])].push_back(t);
      }
    }
    neighbours_.resize(mesh_.triangles.size());
    facet_of_.assign(mesh_.triangles.size(), PlaneTruth::kNone);
    for (const auto& [edge, triangles] : edges) {
      for (const std::uint32_t t : triangles) {
        for (const std::uint32_t u : triangles) {
          if (t != u) neighbours_[t].push_back(u);
        }
      }
    }
  }

  Point area(std::uint32_t t) const {
    const auto [a, b, c] = mesh_.view().corners(t);
    return (b - a).cross(c - a);
  }

  // Those that have one.
  std::vector<std::uint32_t> by_area() const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (area(t).norm() > 0) order.push_back(t);
    }
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::uint32_t t) { return area(t).norm(); });
    return order;
  }

  bool is_near(std::uint32_t t, const Plane& plane) const {
    return std::ranges::all_of(mesh_.triangles[t], [&](std::uint32_t v) {
      return std::abs(plane.signed_distance(mesh_.vertices[v])) <= flatness_;
    });
  }

  std::vector<std::uint32_t> corners_of(const Facet& facet) const {
    std::set<std::uint32_t> corners;
    for (const std::uint32_t t : facet.triangles) {
      corners.insert(mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    }
    return {corners.begin(), corners.end()};
  }

  // Over triangles in the facet's direction, on the plane of all so far.
  void grow(std::uint32_t first) {
    const auto number = static_cast<std::uint32_t>(facets_.size());
    Facet facet{{first}, {}, false};
    facet_of_[first] = number;
    facet.fitted = fit_plane(mesh_.vertices, corners_of(facet));
    std::size_t fitted_at = 1;
    for (std::size_t next = 0; next < facet.triangles.size(); ++next) {
      for (const std::uint32_t t : neighbours_[facet.triangles[next]]) {
        const Plane& plane = facet.fitted.plane;
        if (facet_of_[t] != PlaneTruth::kNone || !is_near(t, plane)) continue;
        if (!(degrees_between(area(t), plane.normal) <= kFacetDegrees)) continue;
        facet_of_[t] = number;
        facet.triangles.push_back(t);
        if (facet.triangles.size() < 2 * fitted_at) continue;
        facet.fitted = fit_plane(mesh_.vertices, corners_of(facet));
        fitted_at = facet.triangles.size();
      }
    }
    facet.fitted = fit_plane(mesh_.vertices, corners_of(facet));
    facets_.push_back(std::move(facet));
  }

  // Where a facet meets another smoothly, it is a part of a curved surface, unless it holds a
  // triangle amid its own, which no strip does, and its corners tell that it is flat.
  bool is_curved(std::uint32_t f) const {
    const Facet& facet = facets_[f];
    bool is_smooth = false, has_inside = false;
    for (const std::uint32_t t : facet.triangles) {
      std::size_t own = 0;
      for (const std::uint32_t u : neighbours_[t]) {
        const std::uint32_t other = facet_of_[u];
        own += other == f;
        if (other == f || other == PlaneTruth::kNone) continue;
        is_smooth |= degrees_between(facet.fitted.plane.normal,
                                     facets_[other].fitted.plane.normal) < kSmoothDegrees;
      }
      has_inside |= own == 3;
    }
    if (!is_smooth) return false;
    const Turning turns = turning(mesh_.vertices, corners_of(facet), facet.fitted);
    return !has_inside || !(turns.error > 0) || turns.angle + turns.error > kFlatRadians;
  }

  const TriangleMesh& mesh_;
  double flatness_;
  std::vector<std::vector<std::uint32_t>> neighbours_;  // of each triangle
  std::vector<std::uint32_t> facet_of_;                 // of each triangle
  std::vector<Facet> facets_;
};

// The number of the plane of each triangle, and the planes.
std::vector<std::uint32_t> planes_of_triangles(const TriangleMesh& mesh, double flatness,
                                               std::vector<Plane>& planes) {
  const Facets facets(mesh, flatness * bounds_of(mesh.vertices).width());
  std::vector<std::uint32_t> of(mesh.triangles.size(), PlaneTruth::kNone);
  for (const Facet& facet : facets.all()) {
    if (facet.is_curved) continue;
    const auto same =
        std::ranges::find_if(planes, [&](const Plane& p) { return facets.lies_on(facet, p); });
    const auto number = static_cast<std::uint32_t>(same - planes.begin());
    if (same == planes.end()) planes.push_back(facet.fitted.plane);
    for (const std::uint32_t t : facet.triangles) of[t] = number;
  }
  return of;
}

}  // namespace

PlaneTruth truth_of(const TriangleMesh& given, std::span<const Point> cloud, double reach,
                    double flatness) {
  TriangleMesh mesh = given;
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  std::vector<Plane> planes;
  const std::vector<std::uint32_t> of = planes_of_triangles(mesh, flatness, planes);
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
