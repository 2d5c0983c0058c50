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
    if (feature) edges_.insert(key(edge[0], edge[1]));
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

void FeatureEdges::collapsed(std::uint32_t a, std::uint32_t b,
                             const std::vector<std::uint32_t>& neighbours) {
  if (edges_.empty()) return;
  for (const std::uint32_t v : neighbours) {
    if (edges_.erase(key(b, v)) > 0 && v != a) edges_.insert(key(a, v));
  }
  if (b >= classes_.size()) return;
  // A vertex that came with a split is simple.
  if (a >= classes_.size()) classes_.resize(a + 1, VertexClass::kSimple);
  classes_[a] = std::max(classes_[a], classes_[b]);
}

}  // namespace emax
