#include "host/picture/colour.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace emax {
namespace {

double luminance(const Colour& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

TEST(Viridis, RunsFromDarkBlueToYellowAndBrightensThroughout) {
  EXPECT_EQ(viridis(0), (Colour{68, 1, 84}));
  EXPECT_EQ(viridis(0.5), (Colour{33, 145, 140}));
  EXPECT_EQ(viridis(1), (Colour{253, 231, 37}));
  EXPECT_EQ(viridis(7), viridis(1));
  for (double x = 0; x < 1; x += 1.0 / 64) {
    EXPECT_LT(luminance(viridis(x)), luminance(viridis(x + 1.0 / 64))) << x;
  }
}

TEST(DeviationColour, TellsTheSidesAndWhatIsBeyondApart) {
  const Colour middle = deviation_colour(0, 2, true);
  EXPECT_LT(
      std::max({middle[0], middle[1], middle[2]}) - std::min({middle[0], middle[1], middle[2]}),
      12);
  for (double d = 0.25; d < 2; d += 0.25) {
    EXPECT_GT(deviation_colour(d, 2, true)[0], deviation_colour(d, 2, true)[2]) << d;
    EXPECT_LT(deviation_colour(-d, 2, true)[0], deviation_colour(-d, 2, true)[2]) << d;
    EXPECT_LT(luminance(deviation_colour(d, 2, true)),
              luminance(deviation_colour(d - 0.25, 2, true)));
  }
  EXPECT_NE(deviation_colour(2, 2, true), deviation_colour(2.001, 2, true));
  EXPECT_NE(deviation_colour(-2, 2, true), deviation_colour(-2.001, 2, true));
  EXPECT_EQ(deviation_colour(1, 2, false), viridis(0.5));
  EXPECT_NE(deviation_colour(2.001, 2, false), viridis(1));
}

}  // namespace
}  // namespace emax
