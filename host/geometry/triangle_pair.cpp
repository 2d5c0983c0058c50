#include "host/geometry/triangle_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "host/geometry/exact_predicates.h"

namespace emax {
namespace {

using Corners = std::array<Point, 3>;
using Point2 = Eigen::Vector2d;

// An axis along which the triangle can be projected without losing its area: the axis of the
// greatest component of its normal, or the next one where that component is only rounding.
int projection_axis(const Corners& t) {
  const Point normal = (t[1] - t[0]).cross(t[2] - t[0]).cwiseAbs();
  int axis = 0;
  normal.maxCoeff(&axis);
  for (int tries = 0; tries < 2; ++tries) {
    if (orient2d(project(t[0], axis), project(t[1], axis), project(t[2], axis)) != 0) break;
    axis = (axis + 1) % 3;
  }
  return axis;
}

// Whether p, known to be on the line through a and b, is between them.
bool between(const Point2& a, const Point2& b, const Point2& p) {
  return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Point2& a, const Point2& b, const Point2& p, const Point2& q) {
  const int ap = orient2d(a, b, p);
  const int aq = orient2d(a, b, q);
  const int pa = orient2d(p, q, a);
  const int pb = orient2d(p, q, b);
  if (ap * aq < 0 && pa * pb < 0) return true;
  return (ap == 0 && between(a, b, p)) || (aq == 0 && between(a, b, q)) ||
         (pa == 0 && between(p, q, a)) || (pb == 0 && between(p, q, b));
}

bool segment_meets_coplanar(const Point& p, const Point& q, const Corners& t) {
  const int axis = projection_axis(t);
  const std::array<Point2, 3> corner{project(t[0], axis), project(t[1], axis), project(t[2], axis)};
  const Point2 from = project(p, axis);
  const Point2 to = project(q, axis);
  const int turn = orient2d(corner[0], corner[1], corner[2]);
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2& a = corner[i];
    const Point2& b = corner[(i + 1) % 3];
    if (segments_meet(a, b, from, to)) return true;
    inside = inside && orient2d(a, b, from) * turn > 0;
  }
  return inside;
}

// `side_p` and `side_q` are the sides of the triangle's plane on which the ends lie.
bool segment_meets(const Point& p, int side_p, const Point& q, int side_q, const Corners& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return segment_meets_coplanar(p, q, t);
  // The line crosses the plane in one point. The point is in the triangle if the line passes all
  // edges on the same side.
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = orient3d(p, q, t[i], t[(i + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
    if (left && right) return false;
  }
  return true;
}

// Whether all corners from `from` on are strictly on one side.
bool one_sided(const std::array<int, 3>& side, std::size_t from) {
  for (std::size_t i = from; i < 3; ++i) {
    if (side[i] == 0 || side[i] != side[from]) return false;
  }
  return true;
}

// The corners before `shared` (0 or 1 of them) are the same vertex of both triangles. Any other
// common point lies on a segment of common points that leaves one of the triangles through the edge
// opposite to that vertex. Without a shared vertex, some edge of one triangle meets the other.
bool meet(const Corners& a, const Corners& b, std::size_t shared) {
  std::array<int, 3> side_b{};
  for (std::size_t i = shared; i < 3; ++i) side_b[i] = orient3d(a[0], a[1], a[2], b[i]);
  if (one_sided(side_b, shared)) return false;
  std::array<int, 3> side_a{};
  for (std::size_t i = shared; i < 3; ++i) side_a[i] = orient3d(b[0], b[1], b[2], a[i]);
  if (one_sided(side_a, shared)) return false;
  for (std::size_t i = shared; i < (shared == 0 ? 3u : 2u); ++i) {
    const std::size_t j = (i + 1) % 3;
    if (segment_meets(b[i], side_b[i], b[j], side_b[j], a)) return true;
    if (segment_meets(a[i], side_a[i], a[j], side_a[j], b)) return true;
  }
  return false;
}

// Whether the triangles (a, b, c) and (a, b, d) are coplanar, with c and d on the same side of the
// shared edge.
bool folded_over(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (orient3d(a, b, c, d) != 0) return false;
  const int axis = projection_axis({a, b, c});
  const Point2 from = project(a, axis);
  const Point2 to = project(b, axis);
  return orient2d(from, to, project(c, axis)) * orient2d(from, to, project(d, axis)) > 0;
}

}  // namespace

bool intersect_beyond_shared(const MeshView& mesh, std::size_t first, std::size_t second) {
  Triangle s = mesh.triangles[first];
  Triangle t = mesh.triangles[second];
  // Shared corners are moved to the front of both triangles, in the same order.
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto same = std::find(t.begin() + static_cast<std::ptrdiff_t>(shared), t.end(), s[i]);
    if (same == t.end()) continue;
    std::swap(t[shared], *same);
    std::swap(s[shared], s[i]);
    ++shared;
  }
  const auto corners = [&](const Triangle& triangle) {
    return Corners{mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                   mesh.vertices[triangle[2]]};
  };
  const Corners a = corners(s);
  const Corners b = corners(t);
  if (shared == 3) return true;
  if (shared == 2) return folded_over(a[0], a[1], a[2], b[2]);
  return meet(a, b, shared);
}

}  // namespace emax
