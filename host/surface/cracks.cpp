#include "host/surface/cracks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/point_tree.h"

namespace emax {
namespace {

constexpr std::size_t kNearest = 40;           // edges that are tested for each edge
constexpr double kCone = 0.7, kFacing = -0.3;  // cosines
constexpr double kAcross = -0.5;               // likewise
constexpr double kDetour = 3;                  // length along the loop, in distances across it

// The direction in the triangle's plane, perpendicular to the edge, that points away from the
// triangle.
Point ahead_of(const RimEdge& edge) {
  const Point along = (edge.to - edge.from).normalized();
  const Point away = edge.from - edge.behind;
  return (away - away.dot(along) * along).normalized();
}

// The distance between vertices around a loop: the side of the square of surface for each vertex.
// Median over the loop, whose vertices have neighbours on one side only.
double spacing_at(std::span<const RimEdge> loop, const PointTree& tree) {
  constexpr std::size_t kAround = 10;
  std::vector<double> squares;
  std::vector<PointTree::Neighbour> near;
  for (const RimEdge& edge : loop) {
    tree.nearest(edge.from, kAround + 1, near);
    squares.push_back(near.back().squared_distance);
  }
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::sqrt(std::numbers::pi / 2 * *middle / kAround);
}

// The middle of an edge on its loop.
struct Place {
  Point middle, ahead;
  std::uint32_t loop;
  double along;  // length of the loop up to this place
};

// Whether the mesh continues ahead of an edge, at the other edge.
bool goes_on(const Place& place, const Place& other, double most) {
  const Point offset = other.middle - place.middle;
  return offset.norm() <= most && offset.dot(place.ahead) > kCone * offset.norm() &&
         other.ahead.dot(place.ahead) < kFacing;
}

// Whether the other edge is on the far side of a slit that the loop runs around. Then neither edge
// is behind the other, as the two sides of a tongue are, and the way along the loop is long. The
// slit may lie along a sharp edge or at the tip of a fin.
bool lies_across(const Place& place, const Place& other, double most, double length) {
  if (place.loop != other.loop) return false;
  const Point offset = other.middle - place.middle;
  const double distance = offset.norm(), along = std::abs(other.along - place.along);
  return distance <= most && offset.dot(place.ahead) > kAcross * distance &&
         -offset.dot(other.ahead) > kAcross * distance &&
         std::min(along, length - along) >= kDetour * distance;
}

double length_of(std::span<const RimEdge> loop) {
  double sum = 0;
  for (const RimEdge& edge : loop) sum += (edge.to - edge.from).norm();
  return sum;
}

bool is_small(std::span<const RimEdge> loop, double most) {
  Point mean = Point::Zero();
  for (const RimEdge& edge : loop) mean += edge.from / static_cast<double>(loop.size());
  return std::ranges::all_of(
      loop, [&](const RimEdge& edge) { return (edge.from - mean).norm() <= most; });
}

}  // namespace

std::vector<bool> find_cracks(std::span<const std::vector<RimEdge>> loops,
                              std::span<const Point> vertices, double crack) {
  if (loops.empty()) return {};
  const PointTree all(vertices);
  std::vector<Place> places;
  std::vector<Point> middles;
  for (std::uint32_t l = 0; l < loops.size(); ++l) {
    double along = 0;
    for (const RimEdge& edge : loops[l]) {
      const double length = (edge.to - edge.from).norm();
      middles.push_back((edge.from + edge.to) / 2);
      places.push_back({middles.back(), ahead_of(edge), l, along + length / 2});
      along += length;
    }
  }
  const PointTree tree(middles);
  std::vector<PointTree::Neighbour> near;
  std::vector<bool> found;
  std::size_t at = 0;
  for (const std::vector<RimEdge>& loop : loops) {
    const double most = std::max(crack, kCrackSpacings * spacing_at(loop, all));
    const double length = length_of(loop);
    std::size_t faced = 0;
    for (const std::size_t end = at + loop.size(); at < end; ++at) {
      const Place& place = places[at];
      tree.nearest(place.middle + most * place.ahead, kNearest, near);
      faced += std::ranges::any_of(near, [&](const PointTree::Neighbour& n) {
        return goes_on(place, places[n.index], 2 * most) ||
               lies_across(place, places[n.index], most, length);
      });
    }
    found.push_back(2 * faced > loop.size() || is_small(loop, most));
  }
  return found;
}

}  // namespace emax
