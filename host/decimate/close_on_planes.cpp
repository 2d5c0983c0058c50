#include "host/decimate/close_on_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "host/geometry/merge_vertices.h"
#include "host/surface/close_holes.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {
namespace {

constexpr std::size_t kMostFolded = 24;  // vertices of a rim that may be folded

// Twice the area of the triangle, along its normal.
Point area_normal(const std::vector<Point>& vertices, const Triangle& t) {
  const Point& a = vertices[t[0]];
  return (vertices[t[1]] - a).cross(vertices[t[2]] - a);
}

Point area_of(const std::vector<Point>& vertices, std::span<const Triangle> triangles) {
  Point area = Point::Zero();
  for (const Triangle& t : triangles) area += area_normal(vertices, t);
  return area;
}

// The triangles with the vertices that they use.
TriangleMesh alone(const std::vector<Point>& vertices, std::span<const Triangle> triangles) {
  TriangleMesh part;
  std::map<std::uint32_t, std::uint32_t> number;
  for (Triangle t : triangles) {
    for (std::uint32_t& v : t) {
      const auto next = static_cast<std::uint32_t>(part.vertices.size());
      const auto [at, is_new] = number.try_emplace(v, next);
      if (is_new) part.vertices.push_back(vertices[v]);
      v = at->second;
    }
    part.triangles.push_back(t);
  }
  return part;
}

// Of any mesh with the vertices of `mesh`.
class FlatHoles {
 public:
  FlatHoles(const TriangleMesh& mesh, const PlaneParts& parts, const PlaneClosing& closing)
      : vertices_(mesh.vertices),
        parts_(parts),
        closing_(closing),
        plane_of_(planes_of_vertices(mesh.vertices, parts, closing.threads)),
        before_(mesh.view()) {}

  // Those on planes of the scan, or those on their own.
  ClosedHoles close(TriangleMesh mesh, bool own) {
    own_ = own;
    return close_chosen_holes(
        std::move(mesh),
        {[&](const HoleRim& rim) { return may_be_flat(rim); },
         [&](const HoleRim& rim, std::span<const Triangle> patch, std::span<const Triangle> gone) {
           return permits(rim, patch, gone);
         }});
  }

  std::size_t wide() const { return wide_; }

 private:
  // The border around a part of a plane turns the other way than a hole's. A short one may also be
  // that of a hole whose rim is folded.
  bool may_be_flat(const HoleRim& rim) const {
    const Point area = area_inside(rim);
    const std::optional<Plane> plane = plane_of(rim.vertices, area);
    return plane && (rim.vertices.size() <= kMostFolded ||
                     same_side(*plane, area, area_of(vertices_, rim.triangles)));
  }

  static bool same_side(const Plane& plane, const Point& a, const Point& b) {
    return plane.normal.dot(a) * plane.normal.dot(b) > 0;
  }

  bool permits(const HoleRim& rim, std::span<const Triangle> patch,
               std::span<const Triangle> gone) {
    const TriangleMesh closes = alone(vertices_, patch);
    std::set<std::uint32_t> corners;
    for (const Triangle& t : patch) corners.insert(t.begin(), t.end());
    const Point area = area_of(vertices_, patch);
    const std::optional<Plane> plane = plane_of({corners.begin(), corners.end()}, area);
    if (!plane) return false;
    const Point around = area_of(vertices_, gone.empty() ? rim.triangles : gone);
    if (!same_side(*plane, area, around)) return false;
    if (!reaches(closes)) {
      if (!own_ && gone.empty()) ++wide_;
      return false;
    }
    return gone.empty() || may_give_way(gone, closes);
  }

  // Whether all of it is close enough to the mesh as it was.
  bool reaches(const TriangleMesh& patch) const {
    if (EMAX_FAULT(kClosesWideHoles)) return true;
    const double farthest = own_ ? closing_.epsilon : closing_.farthest;
    return decided_distance(patch.view(), before_, farthest).within(farthest);
  }

  // The plane of the scan that most vertices are of, or the hole's own: through their mean, at a
  // right angle to the area. Nothing where a vertex is too far from it.
  std::optional<Plane> plane_of(const std::vector<std::uint32_t>& vertices,
                                const Point& area) const {
    const std::optional<Plane> plane = own_ ? own_plane(vertices, area) : most_common(vertices);
    if (!plane) return std::nullopt;
    const bool holds = std::ranges::all_of(vertices, [&](std::uint32_t v) {
      return std::abs(plane->signed_distance(vertices_[v])) <= closing_.epsilon;
    });
    return holds ? plane : std::nullopt;
  }

  std::optional<Plane> own_plane(const std::vector<std::uint32_t>& vertices,
                                 const Point& area) const {
    if (!(area.norm() > 0)) return std::nullopt;
    Point mean = Point::Zero();
    for (const std::uint32_t v : vertices) {
      mean += vertices_[v] / static_cast<double>(vertices.size());
    }
    return Plane{area.normalized(), area.normalized().dot(mean)};
  }

  std::optional<Plane> most_common(const std::vector<std::uint32_t>& vertices) const {
    std::map<std::uint32_t, std::size_t> votes;
    for (const std::uint32_t v : vertices) {
      if (plane_of_[v] < parts_.planes.size()) ++votes[plane_of_[v]];  // no curved shape
    }
    if (votes.empty()) return std::nullopt;
    return parts_.planes[std::ranges::max_element(
                             votes, {}, &std::pair<const std::uint32_t, std::size_t>::second)
                             ->first];
  }

  // Twice the area that the rim encloses, along its normal (Newell).
  Point area_inside(const HoleRim& rim) const {
    const Point& first = vertices_[rim.vertices.front()];
    Point area = Point::Zero();
    for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
      const Point& a = vertices_[rim.vertices[i]];
      const Point& b = vertices_[rim.vertices[(i + 1) % rim.vertices.size()]];
      area += (a - first).cross(b - first);
    }
    return area;
  }

  bool may_give_way(std::span<const Triangle> gone, const TriangleMesh& patch) const {
    const double limit = closing_.epsilon;
    return decided_distance(alone(vertices_, gone).view(), ExactMesh(patch.view()), limit)
        .within(limit);
  }

  const std::vector<Point>& vertices_;
  const PlaneParts& parts_;
  const PlaneClosing& closing_;
  std::vector<std::uint32_t> plane_of_;  // of each vertex
  ExactMesh before_;
  bool own_ = false;
  std::size_t wide_ = 0;
};

}  // namespace

ClosedOnPlanes close_on_planes(const TriangleMesh& mesh, const PlaneParts& parts,
                               const PlaneClosing& closing) {
  FlatHoles holes(mesh, parts, closing);
  ClosedOnPlanes result;
  ClosedHoles first = holes.close(mesh, false);
  ClosedHoles second = holes.close(std::move(first.mesh), true);
  result.mesh = std::move(second.mesh);
  result.on_planes = first.closed;
  result.own = second.closed;
  result.wide = holes.wide();
  const std::size_t left = mesh.triangles.size() - first.dropped - second.dropped;
  for (std::size_t t = left; t < result.mesh.triangles.size(); ++t) {
    result.area += area_normal(mesh.vertices, result.mesh.triangles[t]).norm() / 2;
  }
  drop_unused_vertices(result.mesh.vertices, result.mesh.triangles);
  return result;
}

}  // namespace emax
