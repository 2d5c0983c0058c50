#include "host/decimate/true_edges.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/decimate/shape_place.h"
#include "host/geometry/edge_sides.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {
namespace {

constexpr double kTrueEdge = 40, kEdgeOfMesh = 20;  // degrees
constexpr double kLeastDistance = 0.05;             // of the reach: what is nearer weighs no more
constexpr double kEdgeDamping = 1e-3;               // share of the trace

double cosine_of(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

struct EdgeOfTwo {
  std::uint32_t low, high;
  std::array<std::uint32_t, 2> triangles;
};

class TrueEdgeSampler {
 public:
  TrueEdgeSampler(const TriangleMesh& mesh, std::span<const Shape> shapes,
                  std::span<const std::uint32_t> shape_of, bool smooth, double spacing)
      : mesh_(mesh), shapes_(shapes), shape_of_(shape_of), smooth_(smooth), spacing_(spacing) {}

  std::vector<Point> run() {
    EdgeSides(mesh_.view()).for_each_edge([&](std::span<const EdgeSide> sides) {
      if (sides.size() != 2) return;
      const std::size_t corner = sides[0].lower_corner;
      const EdgeOfTwo edge = {.low = mesh_.triangles[corner / 3][corner % 3],
                              .high = sides[0].upper,
                              .triangles = {triangle_of(sides[0]), triangle_of(sides[1])}};
      if (is_true(edge)) sample(edge);
    });
    return std::move(samples_);
  }

 private:
  static std::uint32_t triangle_of(const EdgeSide& side) {
    return static_cast<std::uint32_t>(side.lower_corner / 3);
  }

  bool is_true(const EdgeOfTwo& edge) const {
    const auto [one, other] = edge.triangles;
    const std::uint32_t first = shape_of_[one], second = shape_of_[other];
    if (first == second && first != kNoIndex) return false;
    if (!smooth_ && (first == kNoIndex || second == kNoIndex)) return false;
    const Point middle = 0.5 * (mesh_.vertices[edge.low] + mesh_.vertices[edge.high]);
    return normal_at(one, middle).dot(normal_at(other, middle)) <= cosine_of(kTrueEdge);
  }

  // Of the shape that the triangle follows, on the side to which the triangle turns.
  Point normal_at(std::uint32_t triangle, const Point& p) const {
    const auto c = mesh_.view().corners(triangle);
    Point own = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    if (shape_of_[triangle] == kNoIndex) return own;
    const Point normal = std::visit([&p](const auto& shape) { return Point(shape.normal_at(p)); },
                                    shapes_[shape_of_[triangle]]);
    return normal.dot(own) < 0 ? Point(-normal) : normal;
  }

  void sample(const EdgeOfTwo& edge) {
    std::vector<Shape> meeting;
    for (const std::uint32_t triangle : edge.triangles) {
      if (shape_of_[triangle] != kNoIndex) meeting.push_back(shapes_[shape_of_[triangle]]);
    }
    const Point &from = mesh_.vertices[edge.low], &to = mesh_.vertices[edge.high];
    const int count = std::max(1, static_cast<int>((to - from).norm() / spacing_));
    for (int i = 0; i < count; ++i) {
      const Point p = from + (i + 0.5) / count * (to - from);
      if (meeting.empty()) {
        samples_.push_back(p);
      } else if (const std::optional<ShapePlace> place = place_on(meeting, p, spacing_)) {
        const Point there = place->project(p);
        if ((there - p).norm() <= spacing_) samples_.push_back(there);
      }
    }
  }

  const TriangleMesh& mesh_;
  std::span<const Shape> shapes_;
  std::span<const std::uint32_t> shape_of_;
  bool smooth_;
  double spacing_;
  std::vector<Point> samples_;
};

// Where the segment is nearest to p, from 0 to 1.
double share_along(const Point& p, const Point& from, const Point& to) {
  const double squared = (to - from).squaredNorm();
  return squared > 0 ? std::clamp((p - from).dot(to - from) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

std::vector<Point> sample_true_edges(const TriangleMesh& mesh, std::span<const Shape> shapes,
                                     std::span<const std::uint32_t> shape_of, bool smooth,
                                     double spacing) {
  return TrueEdgeSampler(mesh, shapes, shape_of, smooth, spacing).run();
}

void TrueEdges::take_edges(const DecimationState& state) {
  const EditableMesh& mesh = state.mesh();
  const double cosine = cosine_of(kEdgeOfMesh);
  edges_.clear();
  for (const std::uint32_t slot : mesh.alive_slots()) {
    const Triangle& t = mesh.triangle(slot);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      const auto [first, second] = mesh.slots_at_edge(low, high);
      if (second == kNoIndex || std::min(first, second) != slot) continue;
      const Point &m = state.area_normal(first), &n = state.area_normal(second);
      if (m.dot(n) < cosine * m.norm() * n.norm()) edges_.push_back({low, high});
    }
  }
  std::ranges::sort(edges_);
  at_vertex_.assign(mesh.vertex_slots(), {});
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    for (const std::uint32_t v : edges_[e]) at_vertex_[v].push_back(e);
  }
}

void TrueEdges::assign(const DecimationState& state) {
  take_edges(state);
  of_edge_.assign(edges_.size(), {});
  if (edges_.empty()) return;
  std::vector<Triangle> segments;
  for (const auto& [a, b] : edges_) segments.push_back({a, b, b});
  const ExactMesh tree(MeshView{state.mesh().positions(), segments});
  std::uint32_t near = 0;
  for (std::uint32_t p = 0; p < samples_.size(); ++p) {
    const ExactMesh::Nearest found = tree.nearest(samples_[p], -HUGE_VAL, near);
    near = found.triangle;
    if (found.distance.upper <= reach_ && !EMAX_FAULT(kForgetsTrueEdges)) {
      of_edge_[near].push_back(p);
    }
  }
}

// Calls visit(sample, the other end) for the edges at a vertex.
template <class Visit>
void TrueEdges::for_each_sample(std::uint32_t vertex, const Visit& visit) const {
  if (vertex >= at_vertex_.size()) return;
  for (const std::uint32_t e : at_vertex_[vertex]) {
    const std::uint32_t other = edges_[e][0] == vertex ? edges_[e][1] : edges_[e][0];
    for (const std::uint32_t p : of_edge_[e]) visit(samples_[p], other);
  }
}

double TrueEdges::distance(const EditableMesh& mesh, std::uint32_t vertex,
                           const Point& there) const {
  double sum = 0;
  for_each_sample(vertex, [&](const Point& p, std::uint32_t other) {
    const Point& end = mesh.position(other);
    sum += (p - there - share_along(p, there, end) * (end - there)).norm();
  });
  return sum;
}

Point TrueEdges::step(const EditableMesh& mesh, std::uint32_t vertex, const Point& from,
                      const Eigen::Matrix3d& along) const {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Point right = Point::Zero();
  for_each_sample(vertex, [&](const Point& p, std::uint32_t other) {
    const Point& end = mesh.position(other);
    const double share = share_along(p, from, end), weight = 1 - share;
    if (weight == 0) return;
    const Point residual = p - from - share * (end - from);
    const double importance = 1 / std::max(residual.norm(), kLeastDistance * reach_);
    Eigen::Matrix3d across = Eigen::Matrix3d::Identity();
    if (share > 0) {
      const Point direction = (end - from).normalized();
      across -= direction * direction.transpose();
    }
    matrix += importance * weight * weight * across;
    right += importance * weight * residual;
  });
  const double trace = matrix.trace();
  if (!(trace > 0)) return from;
  matrix.diagonal().array() += kEdgeDamping * trace;
  matrix = along * matrix * along + trace * (Eigen::Matrix3d::Identity() - along);
  return from + along * matrix.ldlt().solve(along * right);
}

}  // namespace emax
