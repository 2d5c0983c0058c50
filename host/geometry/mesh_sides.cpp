#include "host/geometry/mesh_sides.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "host/geometry/bounds.h"
#include "host/geometry/edge_sides.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

Point normal_of(const std::array<Point, 3>& v) {
  return (v[1] - v[0]).cross(v[2] - v[0]).stableNormalized();
}

double angle_between(const Point& a, const Point& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Where the point of a triangle lies that is nearest to p.
struct Foot {
  Point at;
  std::optional<std::size_t> edge = {}, vertex = {};  // neither: inside
};

// The point of the side from corner i on that is nearest to p; nothing if p projects beyond it.
std::optional<Point> on_side(const Point& p, const Point& from, const Point& to) {
  const Point along = to - from;
  const double part = along.dot(p - from), whole = along.squaredNorm();
  if (!(part > 0 && part < whole)) return std::nullopt;
  return from + part / whole * along;
}

Foot foot_of(const Point& p, const std::array<Point, 3>& v) {
  const Point normal = (v[1] - v[0]).cross(v[2] - v[0]);
  bool inside = normal.squaredNorm() > 0;
  for (std::size_t i = 0; i < 3 && inside; ++i) {
    inside = normal.cross(v[(i + 1) % 3] - v[i]).dot(p - v[i]) > 0;
  }
  if (inside) return {p - (p - v[0]).dot(normal) / normal.squaredNorm() * normal};
  Foot best{v[0], {}, 0};
  double least = (p - v[0]).squaredNorm();
  const auto take = [&](const Foot& foot) {
    const double squared = (p - foot.at).squaredNorm();
    if (squared >= least) return;
    least = squared;
    best = foot;
  };
  take({v[1], {}, 1});
  take({v[2], {}, 2});
  for (std::size_t i = 0; i < 3; ++i) {
    if (const auto at = on_side(p, v[i], v[(i + 1) % 3])) take({*at, i, {}});
  }
  return best;
}

// The place of the side in its triangle.
std::size_t place_of(const EdgeSide& side) {
  return (side.ascends ? side.lower_corner : side.upper_corner) % 3;
}

}  // namespace

MeshSides::MeshSides(MeshView mesh)
    : mesh_(mesh),
      at_edges_(mesh.triangles.size(), {Point::Zero(), Point::Zero(), Point::Zero()}),
      at_vertices_(mesh.vertices.size(), Point::Zero()) {
  if (mesh.triangles.empty()) return;
  std::vector<Point> normals;
  const Point middle = bounds_of(mesh.vertices).midpoint();
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> v = mesh.corners(t);
    normals.push_back(normal_of(v));
    volume += (v[0] - middle).dot((v[1] - middle).cross(v[2] - middle));
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = angle_between(v[(i + 1) % 3] - v[i], v[(i + 2) % 3] - v[i]);
      at_vertices_[mesh.triangles[t][i]] += angle * normals.back();
    }
  }
  bool closed = true;
  EdgeSides(mesh).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() == 1) closed = false;
    Point sum = Point::Zero();
    for (const EdgeSide& side : sides) sum += normals[side.lower_corner / 3];
    for (const EdgeSide& side : sides) at_edges_[side.lower_corner / 3][place_of(side)] = sum;
  });
  inside_out_ = closed && volume < 0;
}

double MeshSides::side_of(const Point& p, std::uint32_t nearest) const {
  const std::array<Point, 3> v = mesh_.corners(nearest);
  const Foot foot = foot_of(p, v);
  Point normal = foot.vertex ? at_vertices_[mesh_.triangles[nearest][*foot.vertex]]
                 : foot.edge ? at_edges_[nearest][*foot.edge]
                             : normal_of(v);
  if (EMAX_FAULT(kSideOfOneTriangle)) normal = normal_of(v);
  const bool negative = (p - foot.at).dot(normal) < 0;
  return negative != inside_out_ ? -1 : 1;
}

}  // namespace emax
