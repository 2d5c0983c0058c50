#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "host/geometry/exact_predicates.h"
#include "host/surface/close_holes.h"

namespace emax {
namespace {

double cosine(const Point& a, const Point& b) {
  const double length = a.norm() * b.norm();
  return length > 0 ? a.dot(b) / length : -1;
}

// The fold of a triangle with this normal against the triangle behind its edge.
double fold_behind(const Point& normal, const Point& from, const Point& to, const Point& behind) {
  return cosine(normal, (from - to).cross(behind - to));
}

class HoleTriangulation {
 public:
  HoleTriangulation(std::span<const Point> hole, std::span<const Point> behind,
                    const std::function<bool(std::size_t, std::size_t)>& may_join)
      : hole_(hole), behind_(behind), may_join_(may_join), first_(hole.size() * hole.size()) {}

  std::optional<HolePatch> run() {
    const std::size_t n = hole_.size();
    for (std::size_t width = 2; width < n; ++width) {
      for (std::size_t i = 0; i + width < n; ++i) solve(i, i + width);
    }
    const Best best = best_at(0, n - 1, nullptr);
    if (!best.quality) return std::nullopt;
    return HolePatch{triangles(best.apex), *best.quality};
  }

 private:
  // The best triangulation of the polygon from corner i to j that has the triangle (i, k, j);
  // `quality` is empty where there is none. The parts of all k are kept, because the fold against a
  // neighbour depends on k.
  struct Part {
    std::optional<PatchQuality> quality;
    std::size_t low = 0, high = 0;  // the apexes of the triangles at (i, k) and (k, j)
  };
  struct Best {
    std::optional<PatchQuality> quality;
    std::size_t apex = 0;
  };

  const Part& at(std::size_t i, std::size_t k, std::size_t j) const {
    return parts_[first_[i * hole_.size() + j] + k - i - 1];
  }

  void solve(std::size_t i, std::size_t j) {
    const bool last = i == 0 && j + 1 == hole_.size();
    const bool allowed = last || may_join_(i, j);
    first_[i * hole_.size() + j] = parts_.size();
    for (std::size_t k = i + 1; k < j; ++k) {
      Part part;
      if (allowed && !collinear(hole_[i], hole_[k], hole_[j])) {
        const Point normal = normal_of(i, k, j);
        const Best low = best_at(i, k, &normal), high = best_at(k, j, &normal);
        if (low.quality && high.quality) {
          part = {PatchQuality{std::min(low.quality->fold, high.quality->fold),
                               low.quality->area + high.quality->area + 0.5 * normal.norm()},
                  low.apex, high.apex};
          if (last) part.quality->fold = std::min(part.quality->fold, fold_at(normal, j, i));
        }
      }
      parts_.push_back(part);
    }
  }

  // The best triangulation of the polygon from corner i to j, including the fold at (i, j) against
  // `normal`.
  Best best_at(std::size_t i, std::size_t j, const Point* normal) const {
    if (j == i + 1) return {PatchQuality{fold_at(*normal, i, j), 0}, 0};
    Best best;
    for (std::size_t k = i + 1; k < j; ++k) {
      std::optional<PatchQuality> quality = at(i, k, j).quality;
      const auto is_best = [&] { return !best.quality || quality->better_than(*best.quality); };
      if (!quality || !is_best()) continue;
      if (normal != nullptr) {
        quality->fold = std::min(quality->fold, cosine(*normal, normal_of(i, k, j)));
      }
      if (is_best()) best = {quality, k};
    }
    return best;
  }

  Point normal_of(std::size_t i, std::size_t k, std::size_t j) const {
    return (hole_[k] - hole_[i]).cross(hole_[j] - hole_[i]);
  }

  double fold_at(const Point& normal, std::size_t from, std::size_t to) const {
    return fold_behind(normal, hole_[from], hole_[to], behind_[from]);
  }

  std::vector<std::array<std::size_t, 3>> triangles(std::size_t apex) const {
    std::vector<std::array<std::size_t, 3>> all, left = {{0, apex, hole_.size() - 1}};
    while (!left.empty()) {
      const auto [i, k, j] = left.back();
      left.pop_back();
      all.push_back({i, k, j});
      const Part& part = at(i, k, j);
      if (k > i + 1) left.push_back({i, part.low, k});
      if (j > k + 1) left.push_back({k, part.high, j});
    }
    return all;
  }

  std::span<const Point> hole_, behind_;
  const std::function<bool(std::size_t, std::size_t)>& may_join_;
  std::vector<std::size_t> first_;  // index of the first part from i to j
  std::vector<Part> parts_;
};

// For many corners. It keeps only the best triangulation of each part of the polygon, whatever will
// be beside it, so the whole may not be the best (Liepa 2003). O(k^3) time, O(k^2) memory.
class QuickTriangulation {
 public:
  QuickTriangulation(std::span<const Point> hole, std::span<const Point> behind,
                     const std::function<bool(std::size_t, std::size_t)>& may_join)
      : hole_(hole), behind_(behind), may_join_(may_join), parts_(hole.size() * hole.size()) {}

  std::optional<HolePatch> run() {
    const std::size_t n = hole_.size();
    for (std::size_t width = 2; width < n; ++width) {
      for (std::size_t i = 0; i + width < n; ++i) solve(i, i + width);
    }
    if (!at(0, n - 1).closed()) return std::nullopt;
    HolePatch patch{{}, at(0, n - 1).quality};
    std::vector<std::pair<std::size_t, std::size_t>> left = {{0, n - 1}};
    while (!left.empty()) {
      const auto [i, j] = left.back();
      left.pop_back();
      if (j == i + 1) continue;
      const std::size_t k = at(i, j).apex;
      patch.triangles.push_back({i, k, j});
      left.insert(left.end(), {{i, k}, {k, j}});
    }
    return patch;
  }

 private:
  // The polygon from corner i to j, with the triangle (i, apex, j).
  struct Part {
    PatchQuality quality;
    Point normal = Point::Zero();
    std::size_t apex = 0;

    bool closed() const { return apex > 0; }
  };

  const Part& at(std::size_t i, std::size_t j) const { return parts_[i * hole_.size() + j]; }

  void solve(std::size_t i, std::size_t j) {
    const bool last = i == 0 && j + 1 == hole_.size();
    if (!last && !may_join_(i, j)) return;
    Part best;
    for (std::size_t k = i + 1; k < j; ++k) {
      const Part &low = at(i, k), &high = at(k, j);
      if ((k > i + 1 && !low.closed()) || (j > k + 1 && !high.closed())) continue;
      PatchQuality quality = {std::min(low.quality.fold, high.quality.fold),
                              low.quality.area + high.quality.area};
      const auto is_best = [&] { return !best.closed() || quality.better_than(best.quality); };
      if (!is_best() || collinear(hole_[i], hole_[k], hole_[j])) continue;
      const Point normal = (hole_[k] - hole_[i]).cross(hole_[j] - hole_[i]);
      quality.area += 0.5 * normal.norm();
      quality.fold = std::min({quality.fold, fold_at(normal, i, k), fold_at(normal, k, j)});
      if (last) {
        quality.fold = std::min(quality.fold, fold_behind(normal, hole_[j], hole_[i], behind_[j]));
      }
      if (is_best()) best = {quality, normal, k};
    }
    parts_[i * hole_.size() + j] = best;
  }

  double fold_at(const Point& normal, std::size_t i, std::size_t j) const {
    return j == i + 1 ? fold_behind(normal, hole_[i], hole_[j], behind_[i])
                      : cosine(normal, at(i, j).normal);
  }

  std::span<const Point> hole_, behind_;
  const std::function<bool(std::size_t, std::size_t)>& may_join_;
  std::vector<Part> parts_;
};

}  // namespace

std::optional<HolePatch> best_patch(std::span<const Point> hole, std::span<const Point> behind,
                                    const std::function<bool(std::size_t, std::size_t)>& may_join) {
  if (hole.size() < 3) return std::nullopt;
  return hole.size() > kExactCorners ? QuickTriangulation(hole, behind, may_join).run()
                                     : HoleTriangulation(hole, behind, may_join).run();
}

}  // namespace emax
