#include "host/picture/raster.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

constexpr std::uint32_t kSize = 64;

std::array<Seen, 3> random_triangle(Random& random) {
  std::array<Seen, 3> v;
  for (Seen& corner : v) {
    const Point p = random.point(-10, 74);
    corner = {p.x(), p.y(), 1 + std::abs(p.z())};
  }
  return v;
}

TEST(Raster, BandsShowWhatTheWholeShows) {
  Random random(named_seed("raster bands", 1));
  Raster whole(kSize, 0, kSize), upper(kSize, 0, 23), lower(kSize, 23, kSize);
  for (std::uint8_t i = 0; i < 60; ++i) {
    const auto v = random_triangle(random);
    for (Raster* raster : {&whole, &upper, &lower}) {
      raster->fill(v, [i](const auto&) { return Colour{i, 0, 0}; });
      raster->disc(v[0], 5, {i, 1, 0});
      raster->line({v[0].x, v[0].y}, {v[1].x, v[1].y}, 0.7, {i, 2, 0});
    }
  }
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const Sample& part = (y < 23 ? upper : lower).at(x, y);
      ASSERT_EQ(whole.at(x, y).colour, part.colour) << x << " " << y;
      ASSERT_EQ(whole.at(x, y).nearness, part.nearness) << x << " " << y;
    }
  }
}

// Triangles round a point cover the square that they share, whatever the roundings.
TEST(Raster, NeighboursLeaveNoGap) {
  Random random(named_seed("raster gaps", 1));
  for (int trial = 0; trial < 200; ++trial) {
    Raster raster(kSize, 0, kSize);
    const Point p = random.point(1, 63);
    const Seen middle{p.x(), p.y(), 1};
    const std::array<Seen, 4> corners = {
        {{-1, -1, 1}, {kSize + 1.0, -1, 1}, {kSize + 1.0, kSize + 1.0, 1}, {-1, kSize + 1.0, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      raster.fill({middle, corners[i], corners[(i + 1) % 4]}, [](const auto&) {
        return Colour{9, 9, 9};
      });
    }
    for (const Sample& sample : raster.samples()) ASSERT_EQ(sample.colour[0], 9) << trial;
  }
}

// The nearest of all planes at each sample, by their equations.
TEST(Raster, ShowsTheNearest) {
  Random random(named_seed("raster depth", 1));
  Raster raster(kSize, 0, kSize);
  std::vector<std::array<Seen, 3>> all;
  for (std::uint8_t i = 0; i < 40; ++i) {
    all.push_back(random_triangle(random));
    raster.fill(all.back(), [i](const auto&) { return Colour{i, 0, 0}; });
  }
  std::size_t checked = 0;
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const Sample& sample = raster.at(x, y);
      double nearest = 0;
      for (const auto& v : all) {
        Eigen::Matrix3d plane;
        for (Eigen::Index i = 0; i < 3; ++i) {
          const Seen& corner = v[static_cast<std::size_t>(i)];
          plane.col(i) << corner.x, corner.y, 1;
        }
        const Eigen::Vector3d weights =
            plane.colPivHouseholderQr().solve(Eigen::Vector3d(x + 0.5, y + 0.5, 1));
        if (weights.minCoeff() < 0) continue;
        nearest = std::max(nearest, weights[0] * v[0].nearness + weights[1] * v[1].nearness +
                                        weights[2] * v[2].nearness);
      }
      EXPECT_NEAR(sample.nearness, nearest, 1e-4 * (1 + nearest)) << x << " " << y;
      checked += nearest > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(checked, kSize * kSize / 2);
}

}  // namespace
}  // namespace emax::test
