#include "host/decimate/plane_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <span>
#include <tuple>
#include <variant>

#include "host/features/find_features.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/point_tree.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kVotes = 5;        // points nearest to a vertex
constexpr int kSmoothings = 3;           // rounds in which the borders between planes are smoothed
constexpr std::size_t kVertices = 1024;  // that a thread takes at a time

Point middle(const std::array<Point, 3>& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3;
}

using Neighbours = std::array<std::uint32_t, 3>;  // of a triangle, over the edge at each corner

std::vector<Neighbours> neighbours_of(const TriangleMesh& mesh) {
  constexpr std::uint32_t kNone = PlaneParts::kNoPlane;
  std::vector<Neighbours> neighbours(mesh.triangles.size(), {kNone, kNone, kNone});
  EdgeSides(mesh.view()).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() != 2) return;
    const auto set = [&](const EdgeSide& side, const EdgeSide& other) {
      const std::size_t first = side.ascends ? side.lower_corner : side.upper_corner;
      neighbours[first / 3][first % 3] = static_cast<std::uint32_t>(other.lower_corner / 3);
    };
    set(sides[0], sides[1]);
    set(sides[1], sides[0]);
  });
  return neighbours;
}

// The plane of most of the points nearest to p; of equal ones, that of the nearest point.
std::uint32_t vote(const PlaneParts& parts, const PointTree& tree, const Point& p,
                   std::vector<PointTree::Neighbour>& found) {
  tree.nearest(p, kVotes, found);
  std::uint32_t best = PlaneParts::kNoPlane;
  std::ptrdiff_t most = 0;
  for (const PointTree::Neighbour& neighbour : found) {
    const std::uint32_t plane = parts.plane_of[neighbour.index];
    const std::ptrdiff_t votes = std::ranges::count_if(
        found, [&](const auto& other) { return parts.plane_of[other.index] == plane; });
    if (votes > most) most = votes, best = plane;
  }
  return best;
}

class Labels {
 public:
  Labels(const TriangleMesh& mesh, const PlaneParts& parts, double reach)
      : mesh_(mesh),
        parts_(parts),
        shapes_(parts.shapes()),
        reach_(reach),
        plane_of_(mesh.triangles.size(), PlaneParts::kNoPlane) {}

  std::vector<std::uint32_t> run(std::size_t threads) && {
    begin(threads);
    neighbours_ = neighbours_of(mesh_);
    grow();
    for (int i = 0; i < kSmoothings; ++i) smooth();
    return std::move(plane_of_);
  }

 private:
  void begin(std::size_t threads) {
    const std::vector<std::uint32_t> of_vertex =
        planes_of_vertices(mesh_.vertices, parts_, threads);
    for (std::uint32_t t = 0; t < plane_of_.size(); ++t) {
      const auto [a, b, c] = mesh_.triangles[t];
      const std::uint32_t plane = of_vertex[a];
      const bool same = plane == of_vertex[b] && plane == of_vertex[c];
      if (same && plane != PlaneParts::kNoPlane && distance(t, plane) <= reach_) {
        plane_of_[t] = plane;
      }
    }
  }

  // Of the farthest corner, and of the middle, which may be farther from what is curved.
  double distance(std::uint32_t triangle, std::uint32_t plane) const {
    const Shape& shape = shapes_[plane];
    const auto corners = mesh_.view().corners(triangle);
    const bool plane_itself = std::holds_alternative<Plane>(shape);
    double farthest = plane_itself ? 0 : emax::distance(shape, middle(corners));
    for (const Point& corner : corners)
      farthest = std::max(farthest, emax::distance(shape, corner));
    return farthest;
  }

  void grow() {
    using Step = std::tuple<double, std::uint32_t, std::uint32_t>;  // distance, triangle, plane
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
    const auto push_around = [&](std::uint32_t triangle) {
      for (const std::uint32_t t : neighbours_[triangle]) {
        if (t == PlaneParts::kNoPlane || plane_of_[t] != PlaneParts::kNoPlane) continue;
        const double far = distance(t, plane_of_[triangle]);
        if (far <= reach_) steps.emplace(far, t, plane_of_[triangle]);
      }
    };
    for (std::uint32_t t = 0; t < plane_of_.size(); ++t) {
      if (plane_of_[t] != PlaneParts::kNoPlane) push_around(t);
    }
    while (!steps.empty()) {
      const auto [far, triangle, plane] = steps.top();
      steps.pop();
      if (plane_of_[triangle] != PlaneParts::kNoPlane) continue;
      plane_of_[triangle] = plane;
      push_around(triangle);
    }
  }

  // A triangle between two of another plane that it may follow, too, follows that one.
  void smooth() {
    for (std::uint32_t t = 0; t < plane_of_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t first = neighbours_[t][i], second = neighbours_[t][(i + 1) % 3];
        if (first == PlaneParts::kNoPlane || second == PlaneParts::kNoPlane) continue;
        const std::uint32_t plane = plane_of_[first];
        if (plane == PlaneParts::kNoPlane || plane == plane_of_[t]) continue;
        if (plane == plane_of_[second] && distance(t, plane) <= reach_) plane_of_[t] = plane;
      }
    }
  }

  const TriangleMesh& mesh_;
  const PlaneParts& parts_;
  std::vector<Shape> shapes_;
  double reach_;
  std::vector<std::uint32_t> plane_of_;
  std::vector<Neighbours> neighbours_;
};

}  // namespace

std::vector<Shape> PlaneParts::shapes() const {
  std::vector<Shape> all(planes.begin(), planes.end());
  all.insert(all.end(), curved.begin(), curved.end());
  return all;
}

PlaneParts find_plane_parts(std::span<const Point> points, double epsilon, std::size_t threads,
                            const std::function<void()>& check, const PlaneThresholds& thresholds) {
  FeatureSearch search;
  search.curved = thresholds.curved;
  search.max_error = thresholds.band * epsilon;
  search.least_support = thresholds.least_points;
  search.threads = threads;
  search.check = check;
  const Features features = find_features(points, search);
  PlaneParts parts;
  parts.points.assign(points.begin(), points.end());
  parts.plane_of.assign(points.size(), PlaneParts::kNoPlane);
  for (const bool curved : {false, true}) {
    for (const Region& region : features.regions) {
      const Plane* plane = std::get_if<Plane>(&region.shape);
      if (curved == (plane != nullptr)) continue;
      const auto number = static_cast<std::uint32_t>(parts.support.size());
      plane != nullptr ? parts.planes.push_back(*plane) : parts.curved.push_back(region.shape);
      parts.support.push_back({region.points.size(), region.rms});
      for (const std::uint32_t p : region.points) parts.plane_of[p] = number;
    }
  }
  return parts;
}

std::vector<std::uint32_t> planes_of_vertices(std::span<const Point> vertices,
                                              const PlaneParts& parts, std::size_t threads) {
  std::vector<std::uint32_t> plane_of(vertices.size(), PlaneParts::kNoPlane);
  if (parts.empty()) return plane_of;
  const PointTree tree(parts.points);
  in_pieces(threads, plane_of.size(), kVertices,
            [&](std::size_t, std::size_t first, std::size_t last) {
              std::vector<PointTree::Neighbour> found;
              for (std::size_t v = first; v < last; ++v) {
                plane_of[v] = vote(parts, tree, vertices[v], found);
              }
            });
  return plane_of;
}

std::vector<std::uint32_t> planes_of_triangles(const TriangleMesh& mesh, const PlaneParts& parts,
                                               double reach, std::size_t threads) {
  return Labels(mesh, parts, reach).run(threads);
}

std::vector<std::uint32_t> shapes_under(const TriangleMesh& mesh, std::span<const Shape> shapes,
                                        double apart, double reach) {
  std::vector<std::uint32_t> under;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = mesh.view().corners(t);
    const auto found = std::ranges::find_if(shapes, [&](const Shape& shape) {
      return std::ranges::all_of(corners,
                                 [&](const Point& p) { return distance(shape, p) <= apart; }) &&
             distance(shape, middle(corners)) <= reach;
    });
    under.push_back(found == shapes.end() ? PlaneParts::kNoPlane
                                          : static_cast<std::uint32_t>(found - shapes.begin()));
  }
  return under;
}

}  // namespace emax
