#include "host/tiles/space_cells.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace emax {
namespace {

struct CellPlane {
  int axis;
  double at;
  std::size_t before, behind;  // the boxes that reach to either side
};

// The plane through the lower corner of a box that divides the boxes best, if one does.
std::optional<CellPlane> best_plane(std::span<const Bounds> boxes, double on_both) {
  constexpr std::size_t kQuarters = 4;
  std::optional<CellPlane> best;
  std::vector<double> lower;
  for (int axis = 0; axis < 3; ++axis) {
    lower.clear();
    for (const Bounds& b : boxes) lower.push_back(b.lower[axis]);
    std::ranges::sort(lower);
    for (std::size_t q = 1; q < kQuarters; ++q) {
      CellPlane plane = {axis, lower[q * lower.size() / kQuarters], 0, 0};
      for (const Bounds& b : boxes) {
        plane.before += b.lower[axis] < plane.at ? 1 : 0;
        plane.behind += b.upper[axis] >= plane.at ? 1 : 0;
      }
      const std::size_t most = std::max(plane.before, plane.behind);
      const std::size_t both = plane.before + plane.behind - boxes.size();
      const bool divides = 5 * most <= 4 * boxes.size() &&
                           static_cast<double>(both) <= on_both * static_cast<double>(boxes.size());
      if (divides && (!best || most < std::max(best->before, best->behind))) best = plane;
    }
  }
  return best;
}

}  // namespace

SpaceCells::SpaceCells(std::vector<Bounds> sample, double weight, double most, const Region& space,
                       double on_both)
    : weight_(weight), most_(most), on_both_(on_both) {
  cut(std::move(sample), space);
}

std::size_t SpaceCells::cut(std::vector<Bounds> sample, const Region& region) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  const bool is_small = static_cast<double>(sample.size()) * weight_ <= most_;
  const std::optional<CellPlane> plane = is_small ? std::nullopt : best_plane(sample, on_both_);
  if (!plane) {
    nodes_[node].first = cells_.size();
    cells_.push_back(region);
    return node;
  }
  std::vector<Bounds> before, behind;
  for (const Bounds& b : sample) {
    if (b.lower[plane->axis] < plane->at) before.push_back(b);
    if (b.upper[plane->axis] >= plane->at) behind.push_back(b);
  }
  std::vector<Bounds>().swap(sample);
  Region first = region, second = region;
  first.upper[plane->axis] = second.lower[plane->axis] = plane->at;
  nodes_[node].axis = plane->axis;
  nodes_[node].plane = plane->at;
  const std::size_t first_node = cut(std::move(before), first);
  const std::size_t second_node = cut(std::move(behind), second);
  nodes_[node].first = first_node;
  nodes_[node].second = second_node;
  return node;
}

}  // namespace emax
