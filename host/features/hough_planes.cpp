#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/features/plane_detection.h"
#include "host/features/plane_grower.h"

namespace emax {
namespace {

// Points whose normal is known no better than to ten degrees do not vote: of sixteen neighbours it
// is known four times better than of one.
constexpr float kVotersTilt = 0.7f;
// Cells of the hemisphere: three faces of a cube, cut into squares of 5 degrees.
constexpr int kCellsOfSide = 18, kCellsOfFace = kCellsOfSide * kCellsOfSide,
              kCells = 3 * kCellsOfFace;
constexpr int kMeanRounds = 3;
constexpr double kMeanAngle = 0.14;  // radians about a direction whose normals make it better

// The cell of a normal; opposite normals have the same.
int cell_of(const Eigen::Vector3f& normal) {
  int face = 0;
  normal.cwiseAbs().maxCoeff(&face);
  const auto place = [&](int axis) {
    const double angle = std::atan(static_cast<double>(normal[axis] / normal[face]));
    const int cell = static_cast<int>((angle / (std::numbers::pi / 2) + 0.5) * kCellsOfSide);
    return std::clamp(cell, 0, kCellsOfSide - 1);
  };
  return face * kCellsOfFace + place((face + 1) % 3) * kCellsOfSide + place((face + 2) % 3);
}

Eigen::Vector3f centre_of(int cell) {
  const int face = cell / kCellsOfFace;
  const auto tangent = [](int place) {
    return static_cast<float>(
        std::tan(((place + 0.5) / kCellsOfSide - 0.5) * std::numbers::pi / 2));
  };
  Eigen::Vector3f centre;
  centre[face] = 1;
  centre[(face + 1) % 3] = tangent(cell % kCellsOfFace / kCellsOfSide);
  centre[(face + 2) % 3] = tangent(cell % kCellsOfSide);
  return centre.normalized();
}

class HoughTransform {
 public:
  HoughTransform(std::span<const Point> points, const Neighbourhoods& near,
                 const FeatureOptions& options)
      : points_(points), near_(near), options_(options), grower_(points, near, options) {
    std::vector<int> cells(points.size(), kCells);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (near.points[i].tilt > kVotersTilt) continue;
      cells[i] = cell_of(near.points[i].normal);
      ++begin_[static_cast<std::size_t>(cells[i]) + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    voters_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (cells[i] < kCells) voters_[next[static_cast<std::size_t>(cells[i])]++] = i;
    }
    for (int cell = 0; cell < kCells; ++cell) centres_.push_back(centre_of(cell));
  }

  std::vector<Region> run() && {
    // The cells in the order of their votes at the beginning, and those with many left once more.
    for (int round = 0; round < 2; ++round) {
      std::vector<std::pair<std::size_t, int>> peaks;
      for (int cell = 0; cell < kCells; ++cell) peaks.emplace_back(free_votes(cell), cell);
      std::ranges::sort(peaks, [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
      });
      for (const auto& [votes, cell] : peaks) {
        if (votes > 0 && free_votes(cell) > 0) search(direction_of(cell));
      }
    }
    return std::move(grower_).finished();
  }

 private:
  std::span<const std::uint32_t> voters(int cell) const {
    const auto c = static_cast<std::size_t>(cell);
    return std::span(voters_).subspan(begin_[c], begin_[c + 1] - begin_[c]);
  }
  std::size_t free_votes(int cell) const {
    const auto of = voters(cell);
    return static_cast<std::size_t>(
        std::count_if(of.begin(), of.end(), [&](std::uint32_t i) { return grower_.may_begin(i); }));
  }

  // Calls take(point) for free voters whose normals are within about `angle` of a direction.
  template <class Take>
  void for_voters(const Eigen::Vector3f& direction, double angle, const Take& take) const {
    constexpr double kHalfDiagonal = 0.07;  // radians, of a cell
    const auto least_of_cell = static_cast<float>(std::cos(angle + kHalfDiagonal));
    const auto least = static_cast<float>(std::cos(angle));
    for (int cell = 0; cell < kCells; ++cell) {
      if (std::abs(centres_[static_cast<std::size_t>(cell)].dot(direction)) < least_of_cell) {
        continue;
      }
      for (const std::uint32_t i : voters(cell)) {
        if (grower_.is_free(i) && std::abs(near_.points[i].normal.dot(direction)) >= least) take(i);
      }
    }
  }

  // The mean of the normals around the cell's, which is where the most are.
  Eigen::Vector3f direction_of(int cell) const {
    Eigen::Vector3f direction = centres_[static_cast<std::size_t>(cell)];
    for (int round = 0; round < kMeanRounds; ++round) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for_voters(direction, kMeanAngle, [&](std::uint32_t i) {
        const Eigen::Vector3f& n = near_.points[i].normal;
        sum += (n.dot(direction) < 0 ? -n : n).cast<double>();
      });
      if (!(sum.norm() > 0)) break;
      direction = sum.normalized().cast<float>();
    }
    return direction;
  }

  // The second step: voters of the direction by the distance of their plane, in bins of two bands.
  void search(const Eigen::Vector3f& direction) {
    const Point normal = direction.cast<double>().normalized();
    std::vector<std::pair<std::int64_t, std::uint32_t>> binned;
    for_voters(direction, options_.angle, [&](std::uint32_t i) {
      const double place = normal.dot(points_[i]) / (2 * options_.band);
      binned.emplace_back(static_cast<std::int64_t>(std::floor(place)), i);
    });
    std::ranges::sort(binned);
    struct Peak {
      std::size_t votes, begin, end;  // of two bins that follow each other
    };
    std::vector<Peak> peaks;
    for (std::size_t begin = 0, end = 0; begin < binned.size();) {
      const std::int64_t bin = binned[begin].first;
      std::size_t next = begin;
      while (next < binned.size() && binned[next].first == bin) ++next;
      end = next;
      while (end < binned.size() && binned[end].first == bin + 1) ++end;
      peaks.push_back({end - begin, begin, end});
      begin = next;
    }
    std::ranges::stable_sort(peaks, std::greater(), &Peak::votes);
    for (const Peak& peak : peaks) {
      if (2 * peak.votes < options_.least_support) break;
      candidates_.clear();
      for (std::size_t b = peak.begin; b < peak.end; ++b) candidates_.push_back(binned[b].second);
      find_regions();
      options_.check();
    }
  }

  // On the plane of candidates_.
  void find_regions() {
    std::erase_if(candidates_, [&](std::uint32_t i) { return !grower_.may_begin(i); });
    if (2 * candidates_.size() < options_.least_support) return;
    const Plane first = fit_plane(points_, candidates_).plane;
    const Plane plane = fit_plane_robustly(points_, candidates_, first).plane;
    for (const std::uint32_t i : candidates_) {
      if (grower_.may_begin(i) && std::abs(plane.signed_distance(points_[i])) <= options_.band) {
        grower_.grow_on(plane, i);
      }
    }
  }

  std::span<const Point> points_;
  const Neighbourhoods& near_;
  FeatureOptions options_;
  PlaneGrower grower_;
  std::vector<std::size_t> begin_ = std::vector<std::size_t>(kCells + 1);  // of a cell's voters
  std::vector<std::uint32_t> voters_;
  std::vector<Eigen::Vector3f> centres_;
  std::vector<std::uint32_t> candidates_;
};

}  // namespace

std::vector<Region> hough_planes(std::span<const Point> points, const Neighbourhoods& near,
                                 const FeatureOptions& options) {
  return HoughTransform(points, near, options).run();
}

}  // namespace emax
