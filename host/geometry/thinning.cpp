#include "host/geometry/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "host/geometry/bounds.h"

namespace emax {
namespace {

// Cells of the side `radius` and a little more, so that roundings put no two points that are closer
// into cells that do not touch. They are numbered on 21 bits an axis: a cloud of more cells has
// wider ones, which only costs time.
class Grid {
 public:
  Grid(std::span<const Point> points, double radius)
      : points_(points), lower_(bounds_of(points).lower) {
    constexpr double kMost = (1 << 21) - 3, kRounding = 0x1p-50;
    const Bounds bounds = bounds_of(points);
    const double greatest = bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).maxCoeff();
    side_ = std::max(1.000001 * radius + kRounding * greatest, bounds.width() / kMost);
  }

  bool has_within(const Point& p, double squared_radius) const {
    const Cell home = cell_of(p);
    if (is_near(home, p, squared_radius)) return true;  // nearly always where there is one
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const Cell cell = {home[0] + x, home[1] + y, home[2] + z};
          if (is_near(cell, p, squared_radius)) return true;
        }
      }
    }
    return false;
  }

  void add(std::uint32_t index) { cells_[key(cell_of(points_[index]))].push_back(index); }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Point& p) const {
    const Point at = (p - lower_) / side_;
    return {static_cast<std::int64_t>(at.x()) + 1, static_cast<std::int64_t>(at.y()) + 1,
            static_cast<std::int64_t>(at.z()) + 1};
  }
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>((c[0] << 42) | (c[1] << 21) | c[2]);
  }
  bool is_near(const Cell& cell, const Point& p, double squared_radius) const {
    const auto found = cells_.find(key(cell));
    if (found == cells_.end()) return false;
    for (const std::uint32_t i : found->second) {
      if ((points_[i] - p).squaredNorm() < squared_radius) return true;
    }
    return false;
  }

  std::span<const Point> points_;
  Point lower_;
  double side_ = 0;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

std::vector<std::uint32_t> thinned(std::span<const Point> points, double radius) {
  std::vector<std::uint32_t> taken;
  if (points.empty()) return taken;
  Grid grid(points, radius);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (grid.has_within(points[i], radius * radius)) continue;
    grid.add(i);
    taken.push_back(i);
  }
  return taken;
}

double thinning_radius(double spacing, std::size_t points, std::size_t count) {
  // Points taken one after the other without order fill the plane to this many a squared radius.
  constexpr double kFilled = 0.7;
  return spacing * std::sqrt(kFilled * static_cast<double>(points) / static_cast<double>(count));
}

}  // namespace emax
