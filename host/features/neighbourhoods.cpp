#include "host/features/neighbourhoods.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kOrientedAtATime = 4096;  // points that a thread takes
constexpr double kFitNoise = 4;                 // two deviations, squared
constexpr double kLineNoise = 9, kLineShare = 0.1;
constexpr std::size_t kGreatestStep = 16;

struct Orientation {
  LocalNormal point;
  bool is_line;  // it spreads in one direction alone by more than noise
};

class Orienter {
 public:
  Orienter(std::span<const Point> points, const PointTree& tree, std::size_t k, double angle,
           double noise)
      : points_(points),
        tree_(tree),
        k_(k),
        squared_sine_(std::pow(std::sin(angle), 2)),
        squared_noise_(noise * noise) {}

  LocalNormal orient(std::uint32_t i, std::span<std::uint32_t> neighbours) {
    for (std::size_t step = 1; step <= kGreatestStep && k_ * step < points_.size(); step *= 4) {
      find(i, step, neighbours);
      const Orientation found = oriented(points_[i], neighbours);
      if (!found.is_line) return found.point;
    }
    find(i, 1, neighbours);
    return oriented(points_[i], neighbours).point;
  }

 private:
  // Every `step`-th of the k step nearest.
  void find(std::uint32_t i, std::size_t step, std::span<std::uint32_t> neighbours) {
    tree_.nearest(points_[i], k_ * step + 1, near_);
    // The point itself is among them unless as many others coincide with it.
    const auto own = std::ranges::find(near_, i, &PointTree::Neighbour::index);
    near_.erase(own == near_.end() ? own - 1 : own);
    for (std::size_t n = 0; n < k_; ++n) neighbours[n] = near_[(n + 1) * step - 1].index;
  }

  Orientation oriented(const Point& at, std::span<const std::uint32_t> neighbours) const {
    Point sum = Point::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (const std::uint32_t i : neighbours) {
      const Point d = points_[i] - at;
      sum += d;
      products.noalias() += d * d.transpose();
    }
    const double count = static_cast<double>(neighbours.size() + 1);
    const Eigen::Matrix3d c = products / count - sum * sum.transpose() / (count * count);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(c);
    const double across = std::max(axes.eigenvalues()[0], 0.0);
    const double shorter = std::max(axes.eigenvalues()[1], 0.0);
    const auto single = [](double value) { return static_cast<float>(value); };
    const float tilt =
        shorter > 0 ? single(std::sqrt(across / shorter)) : std::numeric_limits<float>::infinity();
    return {
        {axes.eigenvectors().col(0).cast<float>(),
         tilt,
         {single(c(0, 0)), single(c(0, 1)), single(c(0, 2)), single(c(1, 1)), single(c(1, 2)),
          single(c(2, 2))},
         single(across + squared_sine_ * shorter + kFitNoise * squared_noise_)},
        shorter <= kLineNoise * squared_noise_ && shorter <= kLineShare * axes.eigenvalues()[2]};
  }

  std::span<const Point> points_;
  const PointTree& tree_;
  std::size_t k_;
  double squared_sine_, squared_noise_;
  std::vector<PointTree::Neighbour> near_;
};

}  // namespace

Neighbourhoods neighbourhoods_of(std::span<const Point> points, const PointTree& tree,
                                 std::size_t k, double angle, double noise, std::size_t threads,
                                 const std::function<void()>& check) {
  Neighbourhoods found;
  if (points.empty()) return found;
  found.k = std::min(k, points.size() - 1);
  found.neighbours.resize(points.size() * found.k);
  found.points.resize(points.size());
  in_pieces(threads, points.size(), kOrientedAtATime,
            [&](std::size_t, std::size_t first, std::size_t last) {
              check();
              Orienter orienter(points, tree, found.k, angle, noise);
              for (std::size_t i = first; i < last; ++i) {
                found.points[i] =
                    orienter.orient(static_cast<std::uint32_t>(i),
                                    std::span(found.neighbours).subspan(i * found.k, found.k));
              }
            });
  return found;
}

}  // namespace emax
