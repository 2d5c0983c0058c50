#include "host/report/curve_svg.h"

#include <gtest/gtest.h>

namespace emax {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(CurveSvg, ShowsEveryPointWithinTheAxes) {
  const std::string svg = curve_svg({{0.5, 1625}, {0.05, 22459}, {0.1, 10194}}, "% of the width");
  EXPECT_EQ(count(svg, "<circle"), 3u);
  EXPECT_EQ(count(svg, "L"), 2u);  // the line, in the order of the tolerances
  for (const char* text : {"0.05: 22459 triangles", ">0.05<", ">1<", ">1000<", ">50000<",
                           "maximum error, % of the width", "</svg>"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(CurveSvg, OfOnePointHasAxes) {
  const std::string svg = curve_svg({{0.2, 100}}, "mm");
  EXPECT_NE(svg.find(">0.2<"), std::string::npos);
  EXPECT_NE(svg.find(">0.5<"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace emax
