#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/geometry/point_tree.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// The normal of a point: what its nearest points say of the surface there.
struct LocalNormal {
  Eigen::Vector3f normal;  // unit, of either sign: of the plane of principal components
  // Standard deviation of the neighbourhood across that plane over the one along its shorter
  // direction: the sine of the angle by which single points tilt the normal. Infinite for points on
  // a line.
  float tilt;
  std::array<float, 6> covariance;  // of the neighbourhood: xx, xy, xz, yy, yz, zz
  float greatest_variance;          // along the normal of a surface that passes here

  // Whether a surface with this unit normal may pass here: the neighbourhood reaches no farther
  // along the normal than `greatest_variance` permits. Neighbours on a line, as scanners that look
  // along a floor leave them, fit every plane through the line, whatever normal they have.
  bool fits(const Eigen::Vector3f& n) const {
    const auto& c = covariance;
    const float along = n[0] * (c[0] * n[0] + 2 * (c[1] * n[1] + c[2] * n[2])) +
                        n[1] * (c[3] * n[1] + 2 * c[4] * n[2]) + c[5] * n[2] * n[2];
    return along <= greatest_variance;
  }
};

// The oriented points of a cloud and the graph of their neighbours.
struct Neighbourhoods {
  std::size_t k = 0;                      // neighbours of each point
  std::vector<std::uint32_t> neighbours;  // k for each point, nearest first, without itself
  std::vector<LocalNormal> points;

  std::span<const std::uint32_t> of(std::size_t i) const {
    return std::span(neighbours).subspan(i * k, k);
  }
};

// Of the k nearest points of each point, or of all where there are fewer. Where these lie on a line
// but for noise, as scanners leave them that sweep faster than they turn, every fourth of 4 k or
// every sixteenth of 16 k points are taken, if those do not. A surface whose normal
// differs by less than `angle` (radians) from a point's fits it, and one that passes within about
// two deviations of `noise` of its neighbours. The same for any number of threads, which call
// `check` now and then. O(n k log k + n log n).
Neighbourhoods neighbourhoods_of(
    std::span<const Point> points, const PointTree& tree, std::size_t k, double angle, double noise,
    std::size_t threads = 1, const std::function<void()>& check = [] {});

}  // namespace emax
