#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "host/decimate/close_holes.h"
#include "host/geometry/exact_predicates.h"

namespace emax {
namespace {

constexpr std::size_t kExactCorners = 60;

double cosine(const Point& a, const Point& b) {
  const double length = a.norm() * b.norm();
  return length > 0 ? a.dot(b) / length : -1;
}

// Of a triangle's normal against the triangle on the other side of its edge.
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
  // Of the polygon from corner i to j with the triangle (i, k, j); nothing where there is no
  // triangulation. How sharply a neighbour folds against it depends on k, so each k is kept.
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

  // Of the polygon from corner i to j, together with the fold at (i, j) against `normal`.
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
  std::vector<std::size_t> first_;  // of the parts from i to j
  std::vector<Part> parts_;
};

// Cuts ears off a polygon of many corners, those with the shortest third edge first.
class Ears {
 public:
  Ears(std::span<const Point> hole, std::span<const Point> behind,
       const std::function<bool(std::size_t, std::size_t)>& may_join)
      : hole_(hole), behind_(behind.begin(), behind.end()), may_join_(may_join) {
    for (std::size_t i = 0; i < hole.size(); ++i) corners.push_back(i);
  }

  // False when none can be cut.
  bool cut() {
    std::optional<std::size_t> best;
    double shortest = 0;
    for (std::size_t p = 0; p < corners.size(); ++p) {
      const auto [a, v, b] = ear(p);
      const double length = (hole_[b] - hole_[a]).norm();
      if ((best && length >= shortest) || !may_join_(a, b)) continue;
      if (collinear(hole_[a], hole_[v], hole_[b])) continue;
      best = p;
      shortest = length;
    }
    if (!best) return false;
    const auto [a, v, b] = ear(*best);
    const Point normal = (hole_[v] - hole_[a]).cross(hole_[b] - hole_[a]);
    patch.triangles.push_back({a, v, b});
    patch.quality.area += 0.5 * normal.norm();
    patch.quality.fold =
        std::min({patch.quality.fold, fold_behind(normal, hole_[a], hole_[v], behind_[a]),
                  fold_behind(normal, hole_[v], hole_[b], behind_[v])});
    behind_[a] = hole_[v];
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(*best));
    return true;
  }

  std::optional<HolePatch> finish() {
    std::vector<Point> hole, behind;
    for (const std::size_t c : corners) {
      hole.push_back(hole_[c]);
      behind.push_back(behind_[c]);
    }
    const std::function<bool(std::size_t, std::size_t)> may_join =
        [this](std::size_t i, std::size_t j) { return may_join_(corners[i], corners[j]); };
    const std::optional<HolePatch> rest = HoleTriangulation(hole, behind, may_join).run();
    if (!rest) return std::nullopt;
    for (const auto& [a, b, c] : rest->triangles) {
      patch.triangles.push_back({corners[a], corners[b], corners[c]});
    }
    patch.quality.area += rest->quality.area;
    patch.quality.fold = std::min(patch.quality.fold, rest->quality.fold);
    return patch;
  }

  std::vector<std::size_t> corners;  // that are left
  HolePatch patch;

 private:
  std::array<std::size_t, 3> ear(std::size_t p) const {
    const std::size_t n = corners.size();
    return {corners[(p + n - 1) % n], corners[p], corners[(p + 1) % n]};
  }

  std::span<const Point> hole_;
  std::vector<Point> behind_;  // of each corner's edge to the next one that is left
  const std::function<bool(std::size_t, std::size_t)>& may_join_;
};

}  // namespace

std::optional<HolePatch> best_patch(std::span<const Point> hole, std::span<const Point> behind,
                                    const std::function<bool(std::size_t, std::size_t)>& may_join) {
  if (hole.size() < 3) return std::nullopt;
  Ears ears(hole, behind, may_join);
  while (ears.corners.size() > kExactCorners) {
    if (!ears.cut()) return std::nullopt;
  }
  return ears.finish();
}

}  // namespace emax
