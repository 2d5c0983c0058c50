#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host/decimate/editable_mesh.h"

namespace emax {

// A corner in the plane of a triangle T, and its height over the plane.
struct PlanarCorner {
  double y, z, height;
};

// The plane of a triangle T, with T's corners in it and T's sides as lines that are positive
// inside.
struct TrianglePlane {
  explicit TrianglePlane(const std::array<Point, 3>& c);

  // y along the first side, z across it.
  PlanarCorner project(const Point& p) const {
    const Point q = p - origin;
    return {along.dot(q), across.dot(q), normal.dot(q)};
  }
  Point lift(const PlanarCorner& c) const { return origin + c.y * along + c.z * across; }
  double inside(std::size_t side, const PlanarCorner& c) const {
    return line[side][0] * c.y + line[side][1] * c.z + line[side][2];
  }
  // The middle of T, without height.
  PlanarCorner middle() const { return {(corners[1].y + corners[2].y) / 3, corners[2].z / 3, 0}; }
  // The sides that a corner is beyond, one bit each.
  unsigned beyond(const PlanarCorner& c) const {
    unsigned sides = 0;
    for (unsigned side = 0; side < 3; ++side) {
      if (inside(side, c) < 0) sides |= 1u << side;
    }
    return sides;
  }
  // Whether a part of T lies to the right of the line from a to b.
  bool reaches_over(const PlanarCorner& a, const PlanarCorner& b) const {
    for (const PlanarCorner& c : corners) {
      if ((b.y - a.y) * (c.z - a.z) < (b.z - a.z) * (c.y - a.y)) return true;
    }
    return false;
  }

  Point origin, along, across, normal;
  std::array<PlanarCorner, 3> corners;
  std::array<std::array<double, 3>, 3> line;
};

// A convex part of T or over T; empty where there is none.
class PartOverTriangle {
 public:
  // The part of a triangle r that is over T. `beyond` holds, for each corner of r, the sides of T
  // that it is beyond.
  void clip(const TrianglePlane& plane, const std::array<PlanarCorner, 3>& r,
            const std::array<unsigned, 3>& beyond);
  // The part of T that the edge from a to b hides from the middle of T, where the middle lies to
  // the left of the edge.
  void shadow(const TrianglePlane& plane, const PlanarCorner& a, const PlanarCorner& b);
  const std::vector<PlanarCorner>& corners() const { return part_; }

 private:
  template <class Side>
  void cut(const Side& inside);

  std::vector<PlanarCorner> part_, clipped_;
};

// T is within the limit, or it could not be proven, or the sheet does not begin under T.
enum class Sheet { kWithin, kUnproven, kNoSheet };

// Follows a sheet of triangles over T. `Faces` describes the sheet:
//   corners(t): the vertices of triangle t; position(v): of a vertex
//   neighbour(t, i): the triangle through the side that begins at corner i, or kNoIndex
//   visited(t): whether visit(t) was called in this search
template <class Faces>
class SheetWalk {
 public:
  // From triangle to triangle across the side beyond which the middle of T lies, until the triangle
  // is under the middle; kNoIndex where the sheet ends or turns before.
  static std::uint32_t under_centroid(const TrianglePlane& plane, std::uint32_t from,
                                      const Faces& faces);

  // From the triangle under the middle of T across every side that a part of T lies beyond, as long
  // as the triangles face the way T does. A straight path in T from the middle to any point passes
  // from one of them to the next, or it leaves the sheet at an edge where the sheet ends or turns
  // away. The point then is in the part of T that this edge hides from the middle. So the triangles
  // and the parts hidden by such edges cover T. What of a triangle is over T needs no proof where
  // it is at most `flat` from the plane of T; part_within(part, t) proves the rest: whether the
  // part of T under `part`, of triangle t or hidden by an edge of it, is within the limit.
  template <class PartWithin>
  Sheet follow_covering(const TrianglePlane& plane, std::uint32_t start, double flat, Faces& faces,
                        const PartWithin& part_within);

 private:
  struct Covering {
    std::uint32_t triangle;
    std::array<PlanarCorner, 3> corners;
    std::array<unsigned, 3> beyond;  // the sides of T that each corner is beyond
  };
  std::vector<Covering> covering_;
  PartOverTriangle part_;
};

// A triangle faces T where twice its area in the projection is more than this share of the squares
// of its sides.
inline constexpr double kSteep = 1e-12;

inline bool faces_plane(const std::array<PlanarCorner, 3>& r) {
  const double u = r[1].y - r[0].y, v = r[1].z - r[0].z;
  const double x = r[2].y - r[0].y, y = r[2].z - r[0].z;
  return u * y - v * x > kSteep * (u * u + v * v + x * x + y * y);
}

template <class Faces>
std::uint32_t SheetWalk<Faces>::under_centroid(const TrianglePlane& plane, std::uint32_t from,
                                               const Faces& faces) {
  constexpr int kMostSteps = 64;
  const auto [y, z, height] = plane.middle();
  for (int step = 0; step < kMostSteps && from != kNoIndex; ++step) {
    std::array<PlanarCorner, 3> r;
    for (std::size_t i = 0; i < 3; ++i) {
      r[i] = plane.project(faces.position(faces.corners(from)[i]));
    }
    double least = 0;
    std::size_t side = 3;
    double area = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanarCorner& a = r[i];
      const PlanarCorner& b = r[(i + 1) % 3];
      const double turn = (a.y - y) * (b.z - z) - (a.z - z) * (b.y - y);
      area += turn;
      if (turn < least) {
        least = turn;
        side = i;
      }
    }
    if (!(area > 0)) return kNoIndex;
    if (side == 3) return from;
    from = faces.neighbour(from, side);
  }
  return kNoIndex;
}

template <class Faces>
template <class PartWithin>
Sheet SheetWalk<Faces>::follow_covering(const TrianglePlane& plane, std::uint32_t start,
                                        double flat, Faces& faces, const PartWithin& part_within) {
  const auto low = [flat](const auto& corners) {
    return std::ranges::all_of(
        corners, [flat](const PlanarCorner& c) { return std::abs(c.height) <= flat; });
  };
  const auto project = [&](std::uint32_t vertex, Covering& at, std::size_t i) {
    at.corners[i] = plane.project(faces.position(vertex));
    at.beyond[i] = plane.beyond(at.corners[i]);
  };
  covering_.clear();
  Covering over{start, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) project(faces.corners(start)[i], over, i);
  if (!faces_plane(over.corners)) return Sheet::kNoSheet;
  faces.visit(start);
  covering_.push_back(over);
  while (!covering_.empty()) {
    const Covering at = covering_.back();
    covering_.pop_back();
    const std::array<PlanarCorner, 3>& r = at.corners;
    if (!low(r)) {
      part_.clip(plane, r, at.beyond);
      const std::vector<PlanarCorner>& part = part_.corners();
      if (part.empty()) continue;
      if (!low(part) && !part_within(part, at.triangle)) return Sheet::kUnproven;
    }
    const Triangle& corners = faces.corners(at.triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if ((at.beyond[i] & at.beyond[j]) != 0 || !plane.reaches_over(r[i], r[j])) continue;
      over.triangle = faces.neighbour(at.triangle, i);
      if (over.triangle != kNoIndex) {
        if (faces.visited(over.triangle)) continue;
        const Triangle& t = faces.corners(over.triangle);
        for (std::size_t k = 0; k < 3; ++k) {
          if (t[k] == corners[i] || t[k] == corners[j]) {
            const std::size_t same = t[k] == corners[i] ? i : j;
            over.corners[k] = r[same];
            over.beyond[k] = at.beyond[same];
          } else {
            project(t[k], over, k);
          }
        }
        if (faces_plane(over.corners)) {
          faces.visit(over.triangle);
          covering_.push_back(over);
          continue;
        }
      }
      part_.shadow(plane, r[i], r[j]);
      if (part_.corners().empty()) continue;
      if (!part_within(part_.corners(), at.triangle)) return Sheet::kUnproven;
    }
  }
  return Sheet::kWithin;
}

}  // namespace emax
