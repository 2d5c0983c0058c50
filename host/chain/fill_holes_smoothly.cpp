#include "host/chain/fill_holes_smoothly.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "host/geometry/disjoint_sets.h"
#include "host/reconstruct/moving_least_squares.h"
#include "host/surface/mesh_orientation.h"
#include "host/vtk_stages/vtk_stages.h"

namespace emax {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Corners = std::array<std::array<double, 3>, 3>;

constexpr int kRings = 3;              // of vertices around a hole that the surface is fitted to
constexpr int kPasses = 40;            // of halving
constexpr std::size_t kMost = 20'000;  // triangles of a patch
constexpr double kLong = 1.5;          // an edge, in mean edges around the hole

Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

Corners corners_of(const TriangleMesh& mesh, const Triangle& t) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point& p = mesh.vertices[t[k]];
    corners[k] = {p.x(), p.y(), p.z()};
  }
  std::ranges::sort(corners);
  return corners;
}

// One connected patch inside a mesh whose vertices it may add to.
class Patch {
 public:
  Patch(TriangleMesh& mesh, std::vector<Triangle> triangles)
      : mesh_(mesh), first_new_(mesh.vertices.size()), triangles_(std::move(triangles)) {
    find_edges();
    double length = 0;
    std::size_t count = 0;
    for (const auto& [edge, sides] : edges_) {
      if (sides.size() != 1) continue;
      rim_.insert({edge.first, edge.second});
      length += length_of(edge);
      ++count;
    }
    target_ = count > 0 ? kLong * length / static_cast<double>(count) : HUGE_VAL;
  }

  const std::set<std::uint32_t>& rim() const { return rim_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

  // Halves long edges inside the patch, and flips edges towards Delaunay's after each pass.
  void refine() {
    for (int pass = 0; pass < kPasses && triangles_.size() < kMost; ++pass) {
      const bool halved = halve_long_edges();
      for (int round = 0; round < kPasses && flip_edges(); ++round) {
      }
      if (!halved) return;
    }
  }

  void move_onto(const LeastSquaresPatch& surface, double farthest) {
    for (std::size_t v = first_new_; v < mesh_.vertices.size(); ++v) {
      const Point moved = surface.project(mesh_.vertices[v]);
      if ((moved - mesh_.vertices[v]).norm() <= farthest) mesh_.vertices[v] = moved;
    }
  }

 private:
  double length_of(const Edge& e) const {
    return (mesh_.vertices[e.first] - mesh_.vertices[e.second]).norm();
  }

  void find_edges() {
    edges_.clear();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        edges_[edge_of(triangles_[t][k], triangles_[t][(k + 1) % 3])].push_back(t);
      }
    }
  }

  // The triangles of an edge inside the patch that no edit of this pass has changed.
  bool is_free(const std::vector<std::size_t>& sides) const {
    return sides.size() == 2 && !changed_[sides[0]] && !changed_[sides[1]];
  }

  bool halve_long_edges() {
    find_edges();
    std::vector<std::pair<double, Edge>> longest;
    for (const auto& [edge, sides] : edges_) {
      if (sides.size() == 2 && length_of(edge) > target_)
        longest.emplace_back(-length_of(edge), edge);
    }
    std::ranges::sort(longest);
    changed_.assign(triangles_.size(), false);
    for (const auto& [length, edge] : longest) {
      const std::vector<std::size_t>& sides = edges_.at(edge);
      if (!is_free(sides)) continue;
      const auto middle = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(0.5 * (mesh_.vertices[edge.first] + mesh_.vertices[edge.second]));
      for (const std::size_t t : sides) {
        Triangle other = triangles_[t];
        std::ranges::replace(other, edge.first, middle);
        std::ranges::replace(triangles_[t], edge.second, middle);
        triangles_.push_back(other);
        changed_[t] = true;
      }
    }
    return !longest.empty();
  }

  // Edges whose opposite angles add up to more than two right ones. False when few were flipped.
  bool flip_edges() {
    find_edges();
    changed_.assign(triangles_.size(), false);
    std::size_t flipped = 0;
    for (const auto& [edge, sides] : edges_) {
      if (!is_free(sides)) continue;
      const std::uint32_t c = opposite(sides[0], edge), d = opposite(sides[1], edge);
      if (c == d || edges_.contains(edge_of(c, d)) || added_.contains(edge_of(c, d))) continue;
      if (rim_.contains(c) && rim_.contains(d)) continue;  // the mesh may have that edge
      constexpr double kClearly = 1e-6;
      if (angle(c, edge) + angle(d, edge) <= std::numbers::pi + kClearly) continue;
      // Replacing one end of the edge by the corner across keeps both triangles' sides.
      Triangle& one = triangles_[sides[0]];
      Triangle& two = triangles_[sides[1]];
      std::ranges::replace(one, edge.first, d);
      std::ranges::replace(two, edge.second, c);
      added_.insert(edge_of(c, d));
      changed_[sides[0]] = changed_[sides[1]] = true;
      ++flipped;
    }
    added_.clear();
    return 20 * flipped > triangles_.size();
  }

  std::uint32_t opposite(std::size_t t, const Edge& edge) const {
    for (const std::uint32_t v : triangles_[t]) {
      if (v != edge.first && v != edge.second) return v;
    }
    return edge.first;
  }

  double angle(std::uint32_t at, const Edge& edge) const {
    const Point u = mesh_.vertices[edge.first] - mesh_.vertices[at];
    const Point w = mesh_.vertices[edge.second] - mesh_.vertices[at];
    return std::atan2(u.cross(w).norm(), u.dot(w));
  }

  TriangleMesh& mesh_;
  std::size_t first_new_;
  std::vector<Triangle> triangles_;
  std::map<Edge, std::vector<std::size_t>> edges_;
  std::set<Edge> added_;
  std::vector<bool> changed_;
  std::set<std::uint32_t> rim_;
  double target_ = 0;
};

// Triangles that share edges, in the order of their first.
std::vector<std::vector<Triangle>> connected(const std::vector<Triangle>& triangles) {
  DisjointSets sets(triangles.size());
  std::map<Edge, std::size_t> first;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge = edge_of(triangles[t][k], triangles[t][(k + 1) % 3]);
      sets.join(first.try_emplace(edge, t).first->second, t);
    }
  }
  std::map<std::size_t, std::vector<Triangle>> parts;
  for (std::size_t t = 0; t < triangles.size(); ++t) parts[sets.root(t)].push_back(triangles[t]);
  std::vector<std::vector<Triangle>> result;
  for (auto& [at, part] : parts) result.push_back(std::move(part));
  return result;
}

}  // namespace

TriangleMesh fill_holes_smoothly(const TriangleMesh& mesh, double size) {
  TriangleMesh filled = fill_holes(mesh, size);
  std::set<Corners> given;
  for (const Triangle& t : mesh.triangles) given.insert(corners_of(mesh, t));
  TriangleMesh result{filled.vertices, {}};
  std::vector<Triangle> added;
  for (const Triangle& t : filled.triangles) {
    (given.contains(corners_of(filled, t)) ? result.triangles : added).push_back(t);
  }
  std::vector<std::vector<std::uint32_t>> neighbours(filled.vertices.size());
  for (const Triangle& t : result.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      neighbours[t[k]].push_back(t[(k + 1) % 3]);
      neighbours[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (std::vector<Triangle>& triangles : connected(added)) {
    Patch patch(result, std::move(triangles));
    std::set<std::uint32_t> around = patch.rim();
    std::vector<std::uint32_t> ring(around.begin(), around.end());
    for (int i = 0; i < kRings; ++i) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t v : ring) {
        for (const std::uint32_t n : neighbours[v]) {
          if (around.insert(n).second) next.push_back(n);
        }
      }
      ring = std::move(next);
    }
    std::vector<Point> points;
    Point middle = Point::Zero();
    for (const std::uint32_t v : around) points.push_back(result.vertices[v]);
    for (const std::uint32_t v : patch.rim()) {
      middle += result.vertices[v] / static_cast<double>(patch.rim().size());
    }
    double radius = 0;
    for (const std::uint32_t v : patch.rim()) {
      radius = std::max(radius, (result.vertices[v] - middle).norm());
    }
    if (radius > 0 && points.size() >= 3) {
      patch.refine();
      patch.move_onto(LeastSquaresPatch(points, radius), radius);
    }
    result.triangles.insert(result.triangles.end(), patch.triangles().begin(),
                            patch.triangles().end());
  }
  drop_unused(result);
  return result;
}

}  // namespace emax
