#include "host/files/tolerance.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "host/files/number_text.h"
#include "host/geometry/bounds.h"
#include "sw_model/base/error.h"
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

// By hand.
TEST(Tolerance, UnitsOfItsOwn) {
  const auto in = [](std::string_view text, std::string_view unit) {
    return parse_tolerance(text).in_unit_of(unit_named(unit)).in_units(1e9);
  };
  EXPECT_EQ(in("0.5mm", "mm"), 0.5);
  EXPECT_DOUBLE_EQ(in("0.5mm", "m"), 0.0005);
  EXPECT_DOUBLE_EQ(in("2cm", "mm"), 20);
  EXPECT_DOUBLE_EQ(in("1m", "mm"), 1000);
  EXPECT_DOUBLE_EQ(in("1in", "mm"), 25.4);
  EXPECT_DOUBLE_EQ(in("1ft", "in"), 12);
  EXPECT_DOUBLE_EQ(in("3937us-ft", "m"), 1200);
  EXPECT_EQ(in("0.5", "mm"), 0.5);
  EXPECT_EQ(in("0.5%", "mm"), 5e6);
  EXPECT_EQ(parse_tolerance("0.5").in_unit_of(std::nullopt).value, 0.5);
  expect_clear(
      message_of([] { parse_tolerance("0.5mm").in_unit_of(std::nullopt, "--back-error"); }),
      "--back-error 0.5mm: ", "does not say its unit", "--unit");
  EXPECT_EQ(to_text(parse_tolerance("0.5"), 200, unit_named("mm")),
            "0.5 mm (0.25% of the width 200 mm)");
}

TEST(Tolerance, OfLevelsOfAccuracy) {
  double last = 1;
  for (const int level : {20, 30, 40, 50}) {
    const double metres = tolerance_of_level(level).in_unit_of(unit_named("m")).value;
    EXPECT_LT(metres, last);
    last = metres;
  }
  EXPECT_DOUBLE_EQ(tolerance_of_level(30).in_unit_of(unit_named("m")).value, 0.015);
  for (const int level : {0, 10, 25, 60}) EXPECT_THROW(tolerance_of_level(level), Error);
}

TEST(Tolerance, NothingElse) {
  for (const std::string text :
       {"",      "%",   "0",    "0%",   "-1",   "-0.5%", "nan",   "nan%", "inf", "-inf", "inf%",
        "1e999", "5km", "5 mm", "0.5 ", " 0.5", "0.5 %", "0.5%%", "%0.5", "0,5", "0x1",  "half",
        "1e",    "--1", "mm",   "0mm",  "5mm%", "5%mm",  "5MM",   "-1ft", "5us"}) {
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
