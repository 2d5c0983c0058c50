#include "host/decimate/cracks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/point_tree.h"

namespace emax {
namespace {

constexpr std::size_t kNearest = 40;           // edges looked at
constexpr double kCone = 0.7, kFacing = -0.3;  // cosines

// In the triangle's plane, away from it.
Point ahead_of(const RimEdge& edge) {
  const Point along = (edge.to - edge.from).normalized();
  const Point away = edge.from - edge.behind;
  return (away - away.dot(along) * along).normalized();
}

// Side of the square that a vertex has of the surface: the median over the loop, where vertices are
// on one side only.
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
  std::vector<Point> middles, ahead;
  for (const std::vector<RimEdge>& loop : loops) {
    for (const RimEdge& edge : loop) {
      middles.push_back((edge.from + edge.to) / 2);
      ahead.push_back(ahead_of(edge));
    }
  }
  const PointTree tree(middles);
  std::vector<PointTree::Neighbour> near;
  std::vector<bool> found;
  std::size_t at = 0;
  for (const std::vector<RimEdge>& loop : loops) {
    const double most = std::max(crack, kCrackSpacings * spacing_at(loop, all));
    std::size_t faced = 0;
    for (const std::size_t end = at + loop.size(); at < end; ++at) {
      tree.nearest(middles[at] + most * ahead[at], kNearest, near);
      faced += std::ranges::any_of(near, [&](const PointTree::Neighbour& n) {
        const Point offset = middles[n.index] - middles[at];
        return offset.norm() <= 2 * most && offset.dot(ahead[at]) > kCone * offset.norm() &&
               ahead[n.index].dot(ahead[at]) < kFacing;
      });
    }
    found.push_back(2 * faced > loop.size() || is_small(loop, most));
  }
  return found;
}

}  // namespace emax
