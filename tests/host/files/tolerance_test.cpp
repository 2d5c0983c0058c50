#include "host/files/tolerance.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "host/files/number_text.h"
#include "host/geometry/bounds.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

TEST(Tolerance, UnitsAndPercent) {
  const Tolerance units = parse_tolerance("0.5");
  EXPECT_FALSE(units.percent);
  EXPECT_EQ(units.in_units(200), 0.5);
  EXPECT_EQ(units.in_percent(200), 0.25);
  const Tolerance percent = parse_tolerance("0.25%");
  EXPECT_TRUE(percent.percent);
  EXPECT_EQ(percent.in_units(200), 0.5);
  EXPECT_EQ(percent.in_percent(200), 0.25);
  EXPECT_EQ(parse_tolerance("1e-3").in_units(7), 1e-3);
  EXPECT_EQ(to_text(units, 200), "0.5 (0.25% of the width 200)");
  EXPECT_EQ(to_text(percent, 200), "0.5 (0.25% of the width 200)");
  EXPECT_EQ(to_text(parse_tolerance("0.321%"), 155.7), "0.499797 (0.321% of the width 155.7)");
}

TEST(Tolerance, NothingElse) {
  for (const std::string text :
       {"",      "%",     "0",    "0%",    "-1",  "-0.5%", "nan",  "nan%",
        "inf",   "-inf",  "inf%", "1e999", "5mm", "5 mm",  "0.5 ", " 0.5",
        "0.5 %", "0.5%%", "%0.5", "0,5",   "0x1", "half",  "1e",   "--1"}) {
    SCOPED_TRACE(text);
    EXPECT_TRUE(message_of([&] {
                  parse_tolerance(text, "--back-error");
                }).starts_with("--back-error " + text + ": "));
    expect_clear(message_of([&] { parse_tolerance(text); }), "--max-error " + text + ": ", "is",
                 "give a number above 0");
  }
}

TEST(NumberText, IsStrict) {
  EXPECT_EQ(parse_double("+1.5"), 1.5);
  EXPECT_EQ(parse_double("-.5e1"), -5.0);
  EXPECT_EQ(parse_double("4.9406564584124654e-324"), 5e-324);
  EXPECT_TRUE(std::isnan(parse_double("NaN").value()));
  for (const std::string text :
       {"", "+", "-", "1 ", " 1", "1x", "+-1", "++1", "1e999", "1,5", "."}) {
    EXPECT_FALSE(parse_double(text)) << text;
  }
  EXPECT_EQ(parse_integer("-12"), -12);
  for (const std::string text : {"", "1.0", "1e3", "9223372036854775808", "0x1"}) {
    EXPECT_FALSE(parse_integer(text)) << text;
  }
}

TEST(NumberText, ShortestTextReadsBackExactly) {
  constexpr std::uint64_t kSeed = 4;
  Random random(kSeed);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random.bits());
    if (!std::isfinite(value)) continue;
    std::string text;
    append_shortest(text, value);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(parse_double(text).value()),
              std::bit_cast<std::uint64_t>(value))
        << text << ", seed " << kSeed;
  }
}

TEST(Bounds, WidthIsTheLongestSide) {
  const std::vector<Point> points{{1, 5, -2}, {3, 4, 7}, {2, 9, 0}};
  const Bounds box = bounds_of(points);
  EXPECT_EQ(box.lower, Point(1, 4, -2));
  EXPECT_EQ(box.upper, Point(3, 9, 7));
  EXPECT_EQ(box.width(), 9);
  EXPECT_EQ(box.midpoint(), Point(2, 6.5, 2.5));
}

}  // namespace
}  // namespace emax::test
