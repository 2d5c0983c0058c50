#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "host/picture/colour.h"
#include "host/picture/view.h"

namespace emax {

struct Sample {
  float nearness = 0;  // of what is seen here; 0: nothing
  Colour colour = {};
};

// A band of rows of a picture, with the nearness of what each sample shows. A sample shows the
// nearest of what was drawn, of equally near things the first, so its colour does not depend on
// how the picture is cut into bands.
class Raster {
 public:
  // `top`, `bottom`: the first row and the one behind the last.
  Raster(std::uint32_t width, std::uint32_t top, std::uint32_t bottom, Sample empty = {})
      : width_(width),
        top_(top),
        bottom_(bottom),
        samples_(std::size_t{width} * (bottom - top), empty) {}

  std::span<const Sample> samples() const { return samples_; }
  const Sample& at(std::uint32_t x, std::uint32_t y) const {
    return samples_[std::size_t{y - top_} * width_ + x];
  }

  // Colours each sample whose middle is in the triangle with shade(distances), the distances in
  // pixels from the sides opposite to the corners.
  template <class Shade>
  void fill(const std::array<Seen, 3>& v, const Shade& shade) {
    const double area =
        (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (v[1].y - v[0].y);
    if (!(std::abs(area) > 0)) return;
    std::array<double, 3> height;  // of each corner above the opposite side
    for (std::size_t i = 0; i < 3; ++i) {
      const Seen &a = v[(i + 1) % 3], &b = v[(i + 2) % 3];
      height[i] = std::abs(area) / std::hypot(b.x - a.x, b.y - a.y);
    }
    const auto [left, right] = std::minmax({v[0].x, v[1].x, v[2].x});
    const auto [high, low] = std::minmax({v[0].y, v[1].y, v[2].y});
    for_each_in(left, right, high, low, [&](double x, double y, Sample& sample) {
      const double b1 =
          ((x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (y - v[0].y)) / area;
      const double b2 =
          ((v[1].x - v[0].x) * (y - v[0].y) - (x - v[0].x) * (v[1].y - v[0].y)) / area;
      const double b0 = 1 - b1 - b2;
      constexpr double kOutside = -1e-9;  // roundings leave no gap between neighbours
      if (b0 < kOutside || b1 < kOutside || b2 < kOutside) return;
      const auto nearness =
          static_cast<float>(b0 * v[0].nearness + b1 * v[1].nearness + b2 * v[2].nearness);
      if (nearness <= sample.nearness) return;
      sample = {nearness, shade(std::array{b0 * height[0], b1 * height[1], b2 * height[2]})};
    });
  }

  // A disc that faces the eye.
  void disc(const Seen& middle, double radius, const Colour& colour) {
    const auto nearness = static_cast<float>(middle.nearness);
    for_each_in(middle.x - radius, middle.x + radius, middle.y - radius, middle.y + radius,
                [&](double x, double y, Sample& sample) {
                  const double dx = x - middle.x, dy = y - middle.y;
                  if (dx * dx + dy * dy > radius * radius || nearness <= sample.nearness) return;
                  sample = {nearness, colour};
                });
  }

  // Lies over all that was drawn: a line with round ends.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius,
            const Colour& colour) {
    const Eigen::Vector2d along = to - from;
    const double length = along.squaredNorm();
    for_each_in(std::min(from.x(), to.x()) - radius, std::max(from.x(), to.x()) + radius,
                std::min(from.y(), to.y()) - radius, std::max(from.y(), to.y()) + radius,
                [&](double x, double y, Sample& sample) {
                  const Eigen::Vector2d p(x - from.x(), y - from.y());
                  const double part = length > 0 ? std::clamp(p.dot(along) / length, 0.0, 1.0) : 0;
                  if ((p - part * along).squaredNorm() <= radius * radius) sample.colour = colour;
                });
  }

  // Calls visit(x, y, sample) with the middle of each sample in the rectangle.
  template <class Visit>
  void for_each_in(double left, double right, double high, double low, const Visit& visit) {
    const auto column = [&](double x) {
      return static_cast<std::uint32_t>(std::clamp(x, 0.0, static_cast<double>(width_)));
    };
    const auto row = [&](double y) {
      return static_cast<std::uint32_t>(
          std::clamp(y, static_cast<double>(top_), static_cast<double>(bottom_)));
    };
    const std::uint32_t first = column(std::ceil(left - 0.5)), last = column(right + 0.5);
    for (std::uint32_t y = row(std::ceil(high - 0.5)); y < row(low + 0.5); ++y) {
      Sample* const begin = &samples_[std::size_t{y - top_} * width_];
      for (std::uint32_t x = first; x < last; ++x) visit(x + 0.5, y + 0.5, begin[x]);
    }
  }

 private:
  std::uint32_t width_, top_, bottom_;
  std::vector<Sample> samples_;
};

}  // namespace emax
