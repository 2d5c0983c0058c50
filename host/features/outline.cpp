#include "host/features/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace emax {
namespace {

using Point2 = Eigen::Vector2d;

constexpr double kCellOfPoints = 2;  // sides of the square that a point has
constexpr int kEmpty = 3;
constexpr double kMostCells = 16;  // for each point
constexpr std::array<std::pair<int, int>, 8> kAround = {
    {{1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}, {0, 1}, {1, 1}}};  // clockwise

// Cells with an empty border of kEmpty, so that no neighbour is outside while they spread and
// shrink.
class CellGrid {
 public:
  CellGrid(int columns, int rows)
      : columns_(columns + 2 * kEmpty), rows_(rows + 2 * kEmpty), full_(size_of(columns_, rows_)) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }
  bool is_full(int x, int y) const { return full_[at(x, y)]; }
  void set(int x, int y, bool full) { full_[at(x, y)] = full; }

  // Every cell that is `full` makes its neighbours so.
  void spread(bool full) {
    const CellGrid before = *this;
    for (int y = 1; y + 1 < rows_; ++y) {
      for (int x = 1; x + 1 < columns_; ++x) {
        if (before.is_full(x, y) != full) continue;
        for (const auto& [dx, dy] : kAround) set(x + dx, y + dy, full);
      }
    }
  }

  void keep_greatest_part();

 private:
  static std::size_t size_of(int columns, int rows) {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  int columns_, rows_;
  std::vector<bool> full_;
};

void CellGrid::keep_greatest_part() {
  std::vector<bool> seen(full_.size());
  std::vector<std::pair<int, int>> greatest;
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      if (!is_full(x, y) || seen[at(x, y)]) continue;
      std::vector<std::pair<int, int>> part = {{x, y}};
      seen[at(x, y)] = true;
      for (std::size_t next = 0; next < part.size(); ++next) {
        for (const auto& [dx, dy] : kAround) {
          const int a = part[next].first + dx, b = part[next].second + dy;
          if (!is_full(a, b) || seen[at(a, b)]) continue;
          seen[at(a, b)] = true;
          part.emplace_back(a, b);
        }
      }
      if (part.size() > greatest.size()) greatest = std::move(part);
    }
  }
  full_.assign(full_.size(), false);
  for (const auto& [x, y] : greatest) set(x, y, true);
}

// The cells of the outer border, in their order around it. The grid holds one part.
std::vector<std::pair<int, int>> border(const CellGrid& grid) {
  int x = 0, y = 0;
  while (!grid.is_full(x, y)) {
    if (++x == grid.columns()) x = 0, ++y;
  }
  std::vector<std::pair<int, int>> cells = {{x, y}};
  int direction = 7;
  for (;;) {
    int turn = 0;
    int next = direction % 2 == 0 ? direction + 7 : direction + 6;
    while (turn < 8 && !grid.is_full(x + kAround[static_cast<std::size_t>(next % 8)].first,
                                     y + kAround[static_cast<std::size_t>(next % 8)].second)) {
      ++next, ++turn;
    }
    if (turn == 8) return cells;  // a single cell
    direction = next % 8;
    x += kAround[static_cast<std::size_t>(direction)].first;
    y += kAround[static_cast<std::size_t>(direction)].second;
    cells.emplace_back(x, y);
    const std::size_t n = cells.size();
    if (n > 3 && cells[n - 1] == cells[1] && cells[n - 2] == cells[0]) break;
  }
  cells.resize(cells.size() - 2);
  return cells;
}

double distance_from_chord(const Point2& p, const Point2& a, const Point2& b) {
  const Point2 chord = b - a, from = p - a;
  const double squared = chord.squaredNorm();
  const double t = squared > 0 ? std::clamp(from.dot(chord) / squared, 0.0, 1.0) : 0;
  return (from - t * chord).norm();
}

// Douglas and Peucker 1973, of both halves of a closed line.
std::vector<Point2> simplified(std::vector<Point2> line, double tolerance) {
  if (line.size() < 4) return line;
  std::size_t opposite = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if ((line[i] - line[0]).norm() > (line[opposite] - line[0]).norm()) opposite = i;
  }
  line.push_back(line.front());
  std::vector<bool> kept(line.size());
  kept[0] = kept[opposite] = true;
  std::vector<std::pair<std::size_t, std::size_t>> chords = {{0, opposite},
                                                             {opposite, line.size() - 1}};
  while (!chords.empty()) {
    const auto [a, b] = chords.back();
    chords.pop_back();
    std::size_t worst = a;
    double greatest = tolerance;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double d = distance_from_chord(line[i], line[a], line[b]);
      if (d > greatest) greatest = d, worst = i;
    }
    if (worst == a) continue;
    kept[worst] = true;
    chords.emplace_back(a, worst);
    chords.emplace_back(worst, b);
  }
  std::vector<Point2> corners;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (kept[i]) corners.push_back(line[i]);
  }
  return corners;
}

double signed_area(const std::vector<Point2>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 &a = polygon[i] - polygon[0], &b = polygon[(i + 1) % polygon.size()] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

}  // namespace

Outline outline_of(std::span<const Eigen::Vector2d> points) {
  if (points.size() < 3) return {};
  Point2 lower = points[0], upper = points[0];
  for (const Point2& p : points) lower = lower.cwiseMin(p), upper = upper.cwiseMax(p);
  const Point2 size = upper - lower;
  if (!(size.minCoeff() > 0)) return {};
  const double n = static_cast<double>(points.size());
  double cell = kCellOfPoints * std::sqrt(size.x() * size.y() / n);
  cell = std::max(cell, size.maxCoeff() / (kMostCells * n));
  CellGrid grid(static_cast<int>(size.x() / cell) + 1, static_cast<int>(size.y() / cell) + 1);
  for (const Point2& p : points) {
    const Point2 place = (p - lower) / cell;
    grid.set(static_cast<int>(place.x()) + kEmpty, static_cast<int>(place.y()) + kEmpty, true);
  }
  grid.spread(true);
  grid.spread(false);
  grid.keep_greatest_part();
  Outline outline;
  for (const auto& [x, y] : border(grid)) {
    outline.polygon.emplace_back(lower + cell * Point2(x - kEmpty + 0.5, y - kEmpty + 0.5));
  }
  outline.polygon = simplified(std::move(outline.polygon), 0.75 * cell);
  outline.area = signed_area(outline.polygon);
  if (outline.area < 0) {
    std::ranges::reverse(outline.polygon);
    outline.area = -outline.area;
  }
  return outline;
}

}  // namespace emax
