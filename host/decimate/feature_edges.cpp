#include "host/decimate/feature_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace emax {
namespace {

// Number of fans that the triangles at a vertex form. Triangles of a fan are joined through the
// edges that they share there.
std::size_t fans(const TriangleMesh& mesh, std::uint32_t vertex,
                 const std::vector<std::uint32_t>& around) {
  std::vector<bool> reached(around.size(), false);
  std::size_t count = 0;
  for (std::size_t first = 0; first < around.size(); ++first) {
    if (reached[first]) continue;
    ++count;
    std::vector<std::size_t> front = {first};
    reached[first] = true;
    while (!front.empty()) {
      const Triangle& t = mesh.triangles[around[front.back()]];
      front.pop_back();
      for (std::size_t i = 0; i < around.size(); ++i) {
        if (reached[i]) continue;
        const Triangle& other = mesh.triangles[around[i]];
        const bool shares = std::ranges::any_of(other, [&](std::uint32_t v) {
          return v != vertex && std::ranges::find(t, v) != t.end();
        });
        if (!shares) continue;
        reached[i] = true;
        front.push_back(i);
      }
    }
  }
  return count;
}

double squared_distance_to_segment(const Point& p, const Point& from, const Point& to) {
  const Point along = to - from;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp(along.dot(p - from) / length, 0.0, 1.0) : 0;
  return (p - from - share * along).squaredNorm();
}

}  // namespace

FeatureEdges::FeatureEdges(const TriangleMesh& mesh, double angle)
    : classes_(mesh.vertices.size(), VertexClass::kSimple) {
  const double least_cosine = std::cos(angle * std::numbers::pi / 180);
  std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> sides;
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
      sides[{low, high}].push_back(t);
      around[corners[i]].push_back(t);
    }
  }
  const auto normal = [&](std::uint32_t t) {
    const auto [a, b, c] = mesh.view().corners(t);
    return Point((b - a).cross(c - a).normalized());
  };
  std::vector<std::uint32_t> features(mesh.vertices.size(), 0), open(features), crowded(features);
  for (const auto& [edge, triangles] : sides) {
    const bool feature =
        triangles.size() == 2 && normal(triangles[0]).dot(normal(triangles[1])) < least_cosine;
    if (feature) {
      edges_[key(edge[0], edge[1])] = {mesh.vertices[edge[0]], mesh.vertices[edge[1]]};
      beside_[edge[0]].push_back(edge[1]);
      beside_[edge[1]].push_back(edge[0]);
    }
    for (const std::uint32_t v : edge) {
      features[v] += feature ? 1 : 0;
      open[v] += triangles.size() == 1 ? 1 : 0;
      crowded[v] += triangles.size() > 2 ? 1 : 0;
    }
  }
  for (std::uint32_t v = 0; v < classes_.size(); ++v) {
    if (around[v].empty()) continue;
    if (crowded[v] > 0 || open[v] > 2 || fans(mesh, v, around[v]) > 1) {
      classes_[v] = VertexClass::kComplex;
    } else if (open[v] > 0) {
      classes_[v] = VertexClass::kBoundary;
    } else if (features[v] > 0) {
      classes_[v] = features[v] == 2 ? VertexClass::kInteriorEdge : VertexClass::kCorner;
    }
  }
}

FeatureEdges::Collapse FeatureEdges::permitted(std::uint32_t a, std::uint32_t b) const {
  const bool first = on_feature(a), second = on_feature(b);
  if (!first && !second) return Collapse::kAnywhere;
  if (first && second) {
    const bool corner_a = vertex_class(a) == VertexClass::kCorner;
    const bool corner_b = vertex_class(b) == VertexClass::kCorner;
    if (!on(a, b) || (corner_a && corner_b)) return Collapse::kForbidden;
    return corner_a ? Collapse::kAtFirst : corner_b ? Collapse::kAtSecond : Collapse::kAlong;
  }
  // A feature that ends at a boundary or a complex vertex keeps its end.
  if (on(a, b)) return first ? Collapse::kAtSecond : Collapse::kAtFirst;
  return first ? Collapse::kAtFirst : Collapse::kAtSecond;
}

FeatureEdges::Shortened FeatureEdges::shorten(std::uint32_t a, std::uint32_t b) const {
  Shortened result;
  for (const std::uint32_t v : {a, b}) {
    const auto others = beside_.find(v);
    if (others == beside_.end()) continue;
    for (const std::uint32_t end : others->second) {
      if (v == b && end == a) continue;  // seen from a
      const std::vector<Point>& passed = edges_.at(key(v, end));
      result.passed.insert(result.passed.end(), passed.begin(), passed.end());
      if (end != b && std::ranges::find(result.ends, end) == result.ends.end()) {
        result.ends.push_back(end);
      }
    }
  }
  return result;
}

bool FeatureEdges::stays_near(std::uint32_t a, std::uint32_t b, const Point& at,
                              std::span<const Point> positions, double squared_distance) const {
  if (!beside_.contains(a) && !beside_.contains(b)) return true;
  const Shortened shortened = shorten(a, b);
  return std::ranges::all_of(shortened.passed, [&](const Point& p) {
    return std::ranges::any_of(shortened.ends, [&](std::uint32_t end) {
      return squared_distance_to_segment(p, at, positions[end]) <= squared_distance;
    });
  });
}

void FeatureEdges::collapsed(std::uint32_t a, std::uint32_t b, std::span<const Point> positions) {
  if (edges_.empty()) return;
  const Shortened shortened = shorten(a, b);
  for (const std::uint32_t v : {a, b}) {
    const auto others = beside_.find(v);
    if (others == beside_.end()) continue;
    for (const std::uint32_t end : others->second) {
      edges_.erase(key(v, end));
      if (end != a && end != b) std::erase(beside_.at(end), v);
    }
    beside_.erase(others);
  }
  for (const std::uint32_t end : shortened.ends) {
    edges_[key(a, end)] = {};
    beside_[end].push_back(a);
  }
  for (const Point& p : shortened.passed) {
    const auto nearest = std::ranges::min_element(shortened.ends, {}, [&](std::uint32_t end) {
      return squared_distance_to_segment(p, positions[a], positions[end]);
    });
    if (nearest != shortened.ends.end()) edges_.at(key(a, *nearest)).push_back(p);
  }
  if (!shortened.ends.empty()) beside_[a] = shortened.ends;
  if (b >= classes_.size()) return;
  // A vertex that came with a split is simple.
  if (a >= classes_.size()) classes_.resize(a + 1, VertexClass::kSimple);
  classes_[a] = std::max(classes_[a], classes_[b]);
}

}  // namespace emax
