#include "host/app/option_checks.h"

#include <gtest/gtest.h>

namespace emax {
namespace {

// What a validator says of a text; empty where it is right.
std::string complaint(const CLI::Validator& check, std::string text) { return check(text); }

TEST(OptionChecks, PositiveTakesFiniteNumbersAboveZero) {
  for (const char* right : {"1", "0.5", "1e-300"})
    EXPECT_EQ(complaint(positive("points"), right), "");
  for (const char* wrong : {"0", "-1", "nan", "inf", "1e999", "", "1x", "one"}) {
    EXPECT_NE(complaint(positive("points"), wrong), "") << wrong;
  }
  EXPECT_EQ(complaint(positive("seconds"), "-2"), "'-2': give a number of seconds above 0");
}

TEST(OptionChecks, WithinTakesBothEndsAndNoNan) {
  for (const char* right : {"0", "180", "12.5"}) EXPECT_EQ(complaint(within(0, 180), right), "");
  for (const char* wrong : {"-0.1", "180.1", "nan", "", "1 2"}) {
    EXPECT_NE(complaint(within(0, 180), wrong), "") << wrong;
  }
}

TEST(OptionChecks, WholeTakesWhatFitsWithoutWrapping) {
  for (const char* right : {"0", "18446744073709551615"}) EXPECT_EQ(complaint(whole(), right), "");
  for (const char* wrong : {"-1", "18446744073709551616", "1.0", "", " 1", "0x10"}) {
    EXPECT_NE(complaint(whole(), wrong), "") << wrong;
  }
}

TEST(OptionChecks, StandardInputHasOneName) {
  std::string name = "/dev/stdin", other = "/dev/stdin.las";
  EXPECT_EQ(standard_input_by_one_name()(name), "");
  EXPECT_EQ(standard_input_by_one_name()(other), "");
  EXPECT_EQ(name, "-");
  EXPECT_EQ(other, "/dev/stdin.las");
}

TEST(OptionChecks, TextsAreNeitherNegativeNorEmpty) {
  EXPECT_EQ(complaint(not_negative(), "5min"), "");
  EXPECT_EQ(complaint(not_negative(), "-5min"), "'-5min' is negative");
  EXPECT_EQ(complaint(not_empty(), "x"), "");
  EXPECT_EQ(complaint(not_empty(), ""), "is empty");
}

TEST(OptionChecks, Utf8IsToldFromOtherBytes) {
  EXPECT_TRUE(is_utf8("Höhe €"));
  EXPECT_FALSE(is_utf8("H\xf6he"));
  EXPECT_FALSE(is_utf8("\xed\xa0\x80"));  // half of a surrogate pair
}

}  // namespace
}  // namespace emax
