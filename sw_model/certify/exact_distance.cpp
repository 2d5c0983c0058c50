#include "sw_model/certify/exact_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/certify/matrix_free.h"
#include "sw_model/certify/rounding.h"

namespace emax {
namespace {

// Non-negative, not all zero: they stand for the point sum(w_i V_i) / sum(w_i) of the triangle.
using Weights = Eigen::Array3d;

// Relative error below 5 kUnitRoundoff for any finite argument.
double norm(const Point& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  const double scale = largest < 0x1p-480 ? 0x1p600 : largest > 0x1p480 ? 0x1p-600 : 1;
  return std::sqrt((v * scale).squaredNorm()) / scale;
}

Point combine(const std::array<Point, 3>& from_p, const Weights& w) {
  return w[0] * from_p[0] + w[1] * from_p[1] + w[2] * from_p[2];
}

// Whether the foot of the perpendicular falls inside the triangle; then its weights. V0V1 is the
// longest edge. The weight of the apex is computed from the part of P across that edge, and the
// position along the edge afterwards. In a sliver the foot then errs by a rounding of the length
// alone, and not by length / height times that.
bool foot_inside(const Point& to_p, const Point& edge, const Point& to_apex, Weights& weights) {
  const double edge_squared = edge.squaredNorm();
  if (!(edge_squared > 0)) return false;
  const Point height = to_apex - to_apex.dot(edge) / edge_squared * edge;
  const double height_squared = height.squaredNorm();
  if (!(height_squared > 0)) return false;
  const Point p_across = to_p - to_p.dot(edge) / edge_squared * edge;
  const double apex = p_across.dot(height) / height_squared;
  const double along = (to_p - apex * to_apex).dot(edge) / edge_squared;
  weights = {1 - along - apex, along, apex};
  return (weights > 0).all();
}

// Position of the nearest point on the edge from `a` to `b`, 0 at `a` and 1 at `b`.
double position_on_edge(const Point& a_from_p, const Point& edge) {
  const double squared = edge.squaredNorm();
  return squared > 0 ? std::clamp(-a_from_p.dot(edge) / squared, 0.0, 1.0) : 0.0;
}

Weights nearest_weights(const std::array<Point, 3>& corners, const std::array<Point, 3>& from_p) {
  std::array<Point, 3> edges;
  std::array<double, 3> squared;
  for (std::size_t i = 0; i < 3; ++i) {
    edges[i] = corners[(i + 1) % 3] - corners[i];
    squared[i] = edges[i].squaredNorm();
  }
  const std::size_t i0 =
      static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
  const std::size_t i1 = (i0 + 1) % 3, i2 = (i0 + 2) % 3;

  Weights best = Weights::Zero();
  double least = kInfinity;
  Weights foot;
  if (foot_inside(-from_p[i0], edges[i0], -edges[i2], foot)) {
    best[static_cast<Eigen::Index>(i0)] = foot[0];
    best[static_cast<Eigen::Index>(i1)] = foot[1];
    best[static_cast<Eigen::Index>(i2)] = foot[2];
    least = combine(from_p, best).squaredNorm();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = position_on_edge(from_p[i], edges[i]);
    Weights w = Weights::Zero();
    w[static_cast<Eigen::Index>(i)] = 1 - t;
    w[static_cast<Eigen::Index>((i + 1) % 3)] = t;
    const double distance_squared = combine(from_p, w).squaredNorm();
    if (distance_squared < least) {
      least = distance_squared;
      best = w;
    }
  }
  return best.sum() > 0 ? best : Weights(1, 0, 0);
}

// A bound from above on the square, to compare with squared box distances.
double squared_up(double value) {
  return std::nextafter(value * value * (1 + 8 * kUnitRoundoff), kInfinity);
}

// At most the squared distance from p to anything in the box.
double squared_distance_to_box(const Point& p, const Point& low, const Point& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm() * (1 - 8 * kUnitRoundoff);
}

constexpr std::uint32_t kLeafSize = 4;
constexpr std::uint32_t kNone = ~0u;
constexpr std::size_t kMostLevels = 64;  // a median split halves 2^32 triangles in 32 levels

DistanceBounds bounds(const Point& p, const std::array<Point, 3>& corners) {
  const std::array<Point, 3> from_p = {corners[0] - p, corners[1] - p, corners[2] - p};
  for (const Point& v : from_p) {
    // A difference of binary64 numbers is 0 only where they agree.
    if ((v.array() == 0).all()) return {0, 0};
  }
  const Weights w = nearest_weights(corners, from_p);
  const Point to_nearest = combine(from_p, w);
  const double length = norm(to_nearest);

  // docs/numerics.md, "The oracle's rounding", derives both constants.
  const std::array<double, 3> sizes = {from_p[0].lpNorm<1>(), from_p[1].lpNorm<1>(),
                                       from_p[2].lpNorm<1>()};
  const double spread = w[0] * sizes[0] + w[1] * sizes[1] + w[2] * sizes[2];
  const double upper =
      (length + 5 * kUnitRoundoff * spread) / w.sum() * (1 + 16 * kUnitRoundoff) + 0x1p-1060;

  double lower = 0;
  if (length > 0x1p-900) {
    const Point n = to_nearest / length;
    const double support = std::min({from_p[0].dot(n), from_p[1].dot(n), from_p[2].dot(n)});
    lower = support * (1 - 16 * kUnitRoundoff) -
            6 * kUnitRoundoff * std::max({sizes[0], sizes[1], sizes[2]}) - 0x1p-1060;
  }
  return {std::max(lower, 0.0), std::nextafter(upper, kInfinity)};
}

// True only where the triangle is proven to be farther than `upper`; costs a fifth of `bounds`. The
// direction is guessed: the bound holds for any direction, and a bad guess only gives false.
bool is_farther(const Point& p, const std::array<Point, 3>& corners, double upper) {
  const Point direction = -ericson_offset(p, corners[0], corners[1], corners[2]);
  double support = kInfinity, size = 0;
  for (const Point& corner : corners) {
    const Point from_p = corner - p;
    support = std::min(support, from_p.dot(direction));
    size = std::max(size, from_p.lpNorm<1>());
  }
  const double least = upper + 8 * kUnitRoundoff * size;
  const double squared = direction.squaredNorm();
  return support > 0 && squared > 0x1p-500 && squared < 0x1p500 && least < 0x1p250 &&
         support * support > squared * (least * least) * (1 + 64 * kUnitRoundoff);
}

// A point of the triangle, mostly the nearest, by Ericson's formula: weights of b and c, both at
// least 0 and together at most 1 up to a rounding. `a`, `b`, `c` lead from the point to the
// corners.
struct Foot {
  double b, c;
};

inline Foot likely_foot(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - t, t};
  }
  const double scale = 1 / (va + vb + vc);
  return {vb * scale, vc * scale};
}

bool is_sliver(const std::array<Point, 3>& corners, double scale) {
  const Point ab = scale * (corners[1] - corners[0]), ac = scale * (corners[2] - corners[0]);
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return !(ab.cross(ac).squaredNorm() > 1e-6 * longest * longest && longest > 0x1p-200);
}

constexpr double kLeastPlain = 0x1p-400, kMostPlain = 0x1p400;

}  // namespace

DistanceBounds point_triangle_distance(const Point& p, const std::array<Point, 3>& corners) {
  require_no_flush("the exact distance");
  return bounds(p, corners);
}

void require_measurable(MeshView mesh) {
  if (mesh.triangles.empty()) throw Error("the mesh has no triangles: no distance to it exists");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex >= mesh.vertices.size()) {
        throw std::invalid_argument("triangle " + std::to_string(i) + " names vertex " +
                                    std::to_string(vertex) + ", which does not exist");
      }
      if (!(mesh.vertices[vertex].array().abs() < 1e150).all()) {  // also for NaN
        throw Error("triangle " + std::to_string(i) +
                    " has a vertex that is not finite or beyond 1e150: correct the mesh");
      }
    }
  }
}

double lower_end(const Point& p, MeshView part, double upper) {
  require_no_flush("the exact distance");
  const double upper_squared = squared_up(upper);
  double lower = upper;
  for (std::size_t i = 0; i < part.triangles.size(); ++i) {
    const std::array<Point, 3> corners = part.corners(i);
    const Point low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Point high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    if (squared_distance_to_box(p, low, high) > upper_squared) continue;
    if (!is_farther(p, corners, upper)) lower = std::min(lower, bounds(p, corners).lower);
  }
  return lower;
}

ExactMesh::ExactMesh(MeshView mesh) {
  require_no_flush("the exact distance");
  require_measurable(mesh);
  const std::size_t count = mesh.triangles.size();
  {
    std::vector<Centre> centres;
    centres.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::array<Point, 3> corners = mesh.corners(i);
      centres.push_back({corners[0] / 3 + corners[1] / 3 + corners[2] / 3, i});
    }
    nodes_.reserve(2 * count / kLeafSize + 1);
    build(mesh, 0, static_cast<std::uint32_t>(count), centres);
    order_.resize(count);
    for (std::uint32_t place = 0; place < count; ++place) order_[place] = centres[place].triangle;
  }
  take_triangles(mesh);
  const double extent = (nodes_[0].high - nodes_[0].low).maxCoeff();
  if (extent > 0x1p-900) {
    scale_ = std::ldexp(1, -std::ilogb(extent));
    unscale_ = 1 / scale_;
  }
  is_sliver_.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) {
    is_sliver_[place] = is_sliver(corners_at(place), scale_) ? 1 : 0;
  }
}

// In the order of the tree, which is that in which leaves read them.
void ExactMesh::take_triangles(MeshView mesh) {
  const std::size_t count = order_.size();
  place_of_.resize(count);
  triangles_.resize(count);
  std::vector<std::uint32_t> taken(mesh.vertices.size(), kNone);
  for (std::uint32_t place = 0; place < count; ++place) {
    place_of_[order_[place]] = place;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[order_[place]][k];
      if (taken[vertex] == kNone) {
        taken[vertex] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(mesh.vertices[vertex]);
      }
      triangles_[place][k] = taken[vertex];
    }
  }
  vertices_.shrink_to_fit();
}

std::uint32_t ExactMesh::build(MeshView mesh, std::uint32_t begin, std::uint32_t end,
                               std::vector<Centre>& centres) {
  const std::uint32_t node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Point::Constant(kInfinity), Point::Constant(-kInfinity), begin, end, 0});
  const auto enclose = [&](const Point& low, const Point& high) {
    nodes_[node].low = nodes_[node].low.cwiseMin(low);
    nodes_[node].high = nodes_[node].high.cwiseMax(high);
  };
  if (end - begin <= kLeafSize) {
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const Point& corner : mesh.corners(centres[i].triangle)) enclose(corner, corner);
    }
    return node;
  }
  Point low = Point::Constant(kInfinity), high = -low;  // of the centres
  for (std::uint32_t i = begin; i < end; ++i) {
    low = low.cwiseMin(centres[i].at);
    high = high.cwiseMax(centres[i].at);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(centres.begin() + begin, centres.begin() + middle, centres.begin() + end,
                   [&](const Centre& a, const Centre& b) { return a.at[axis] < b.at[axis]; });
  const std::uint32_t left = build(mesh, begin, middle, centres);
  const std::uint32_t right = build(mesh, middle, end, centres);
  nodes_[node].right = right;
  for (const std::uint32_t child : {left, right}) enclose(nodes_[child].low, nodes_[child].high);
  return node;
}

DistanceBounds ExactMesh::distance_to(const Point& p, std::uint32_t triangle) const {
  require_no_flush("the exact distance");
  return bounds(p, corners_at(place_of_.at(triangle)));
}

// docs/numerics.md, "The oracle's rounding": the square of a length, and a size, such that the
// triangle is at most length + 6 kUnitRoundoff size away, and (1 + 32 kUnitRoundoff) times that.
// Both are times scale_. Nothing where plain arithmetic does not prove that.
inline std::optional<ExactMesh::Quick> ExactMesh::quick(const Point& p, std::uint32_t place) const {
  if (is_sliver_[place]) return std::nullopt;
  const std::array<Point, 3> corners = corners_at(place);
  const Point a = scale_ * (corners[0] - p), b = scale_ * (corners[1] - p),
              c = scale_ * (corners[2] - p);
  const Foot foot = likely_foot(a, b, c);
  const double weight = (1 - foot.b) - foot.c;
  const double squared = (std::max(weight, 0.0) * a + foot.b * b + foot.c * c).squaredNorm();
  if (!(foot.b >= 0 && foot.c >= 0 && weight >= -0x1p-50 && squared > kLeastPlain &&
        squared < kMostPlain)) {
    return std::nullopt;
  }
  return Quick{squared, std::max({a.lpNorm<1>(), b.lpNorm<1>(), c.lpNorm<1>()})};
}

double ExactMesh::upper_to(const Point& p, std::uint32_t triangle) const {
  const std::uint32_t place = place_of_[triangle];
  if (const std::optional<Quick> found = quick(p, place)) {
    return (std::sqrt(found->squared) + 6 * kUnitRoundoff * found->size) *
               (1 + 32 * kUnitRoundoff) * unscale_ +
           0x1p-1060;
  }
  return bounds(p, corners_at(place)).upper;
}

// The square of about the distance.
inline double ExactMesh::likely_squared(const Point& p, std::uint32_t place) const {
  const std::array<Point, 3> corners = corners_at(place);
  if (!is_sliver_[place]) {
    const Point a = scale_ * (corners[0] - p), b = scale_ * (corners[1] - p),
                c = scale_ * (corners[2] - p);
    const Foot foot = likely_foot(a, b, c);
    const double squared = (((1 - foot.b) - foot.c) * a + foot.b * b + foot.c * c).squaredNorm();
    if (squared > kLeastPlain && squared < kMostPlain) return squared * unscale_ * unscale_;
  }
  const double upper = bounds(p, corners).upper;
  return upper * upper;
}

std::uint32_t ExactMesh::likely_nearest(const Point& p, std::uint32_t seed) const {
  std::uint32_t best = place_of_[seed];
  double least = likely_squared(p, best);
  struct Pending {
    std::uint32_t node;
    double squared_distance;
  };
  std::array<Pending, kMostLevels> stack;
  std::size_t depth = 0;
  std::uint32_t at = 0;
  for (;;) {
    const Node& node = nodes_[at];
    if (node.right != 0) {
      Pending near = {at + 1, 0}, far = {node.right, 0};
      for (Pending* child : {&near, &far}) {
        const Node& box = nodes_[child->node];
        child->squared_distance = (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).squaredNorm();
      }
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      if (near.squared_distance < least) {
        if (far.squared_distance < least) stack[depth++] = far;
        at = near.node;
        continue;
      }
    } else {
      for (std::uint32_t place = node.begin; place < node.end; ++place) {
        const double squared = likely_squared(p, place);
        if (squared < least) {
          least = squared;
          best = place;
        }
      }
    }
    do {
      if (depth == 0) return order_[best];
      --depth;
    } while (!(stack[depth].squared_distance < least));
    at = stack[depth].node;
  }
}

bool ExactMesh::is_within(const Point& p, std::uint32_t triangle, double limit) const {
  const std::uint32_t place = place_of_.at(triangle);
  const std::array<Point, 3> corners = corners_at(place);
  // docs/numerics.md, "The oracle's rounding": such a corner, or such a point of the triangle,
  // keeps the upper end within the limit.
  if (limit > 0x1p-400 && limit < 0x1p400) {
    double nearest = kInfinity, farthest = 0;
    for (const Point& corner : corners) {
      const double squared = (corner - p).squaredNorm();
      nearest = std::min(nearest, squared);
      farthest = std::max(farthest, squared);
    }
    if (nearest <= 0.25 * limit * limit && farthest <= 0x1p60 * limit * limit) return true;
    const double scaled = scale_ * limit;
    const std::optional<Quick> found = quick(p, place);
    if (found && found->squared <= (1 - 0x1p-20) * scaled * scaled && found->size <= 0x1p8 * scaled)
      return true;
  }
  require_no_flush("the exact distance");
  return bounds(p, corners).upper <= limit;
}

ExactMesh::Nearest ExactMesh::nearest(const Point& p, double enough, std::uint32_t seed) const {
  require_no_flush("the exact distance");
  Nearest best = {{kInfinity, kInfinity}, 0};
  if (seed < order_.size()) best = {bounds(p, corners_at(place_of_[seed])), seed};
  return search(p, enough, best);
}

void ExactMesh::lower(const Point& p, std::uint32_t first, Nearest& least) const {
  require_no_flush("the exact distance");
  const Nearest found = search(p, -kInfinity, least);
  if (!(found.distance.upper < least.distance.upper)) return;
  least.distance.upper = found.distance.upper;
  least.triangle = first + found.triangle;
}

ExactMesh::Nearest ExactMesh::search(const Point& p, double enough, Nearest best) const {
  double best_squared = squared_up(best.distance.upper);
  struct Pending {
    std::uint32_t node;
    double squared_distance;
  };
  std::array<Pending, kMostLevels> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 0};
  while (depth > 0) {
    const Pending pending = stack[--depth];
    if (pending.squared_distance > best_squared) continue;
    const Node& node = nodes_[pending.node];
    if (node.right != 0) {
      Pending near = {pending.node + 1, 0}, far = {node.right, 0};
      for (Pending* child : {&near, &far}) {
        const Node& box = nodes_[child->node];
        child->squared_distance = squared_distance_to_box(p, box.low, box.high);
      }
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
      continue;
    }
    for (std::uint32_t place = node.begin; place < node.end; ++place) {
      const std::array<Point, 3> corners = corners_at(place);
      if (is_farther(p, corners, best.distance.upper)) continue;
      const DistanceBounds distance = bounds(p, corners);
      best.distance.lower = std::min(best.distance.lower, distance.lower);
      if (distance.upper < best.distance.upper ||
          (distance.upper == best.distance.upper && order_[place] < best.triangle)) {
        best.distance.upper = distance.upper;
        best.triangle = order_[place];
        best_squared = squared_up(distance.upper);
        if (distance.upper <= enough) return {{0, distance.upper}, best.triangle};
      }
    }
  }
  return best;
}

}  // namespace emax
