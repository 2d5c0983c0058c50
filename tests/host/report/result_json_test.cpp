#include "host/report/result_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace emax {
namespace {

nlohmann::json written(const ResultReport& report) {
  const std::string text = to_json_text(report);
  EXPECT_EQ(text.back(), '\n');
  return nlohmann::json::parse(text);
}

TEST(ResultJson, HoldsEveryKeyAndNullWhereNothingWasAskedFor) {
  const nlohmann::json json = written({});
  for (const char* key :
       {"feasible",        "valid",           "triangles",          "epsilon",
        "e_max",           "e_max_all",       "e_max_squared_bits", "worst_point",
        "evaluations",     "failures",        "ended_by",           "seed",
        "device_counters", "validity",        "topology",           "reconstruction_triangles",
        "unmeshed_points", "lost_attributes", "reference",          "predicted",
        "errors"}) {
    ASSERT_TRUE(json.contains(key)) << key;
    EXPECT_TRUE(json[key].is_null()) << key;
  }
  EXPECT_EQ(json["schema"], "emax-result-1");
  EXPECT_EQ(json["bound"], "one-sided");
  EXPECT_EQ(json["points"], 0);
  EXPECT_TRUE(json["excluded"].empty());
}

TEST(ResultJson, SaysWhatWasMeasured) {
  ResultReport report;
  report.feasible = true;
  report.two_sided = true;
  report.epsilon = 0.5;
  report.kernel = EmaxResult{0x3829f8c4, 7};
  report.certified = CertifiedError{};
  report.certified->e_max_upper = 0.25;
  report.certified->excluded = {3};
  report.certified->excluded_distances = {0.75};
  report.certified->e_max_upper_all = 0.75;
  report.failures = std::map<std::string, std::uint64_t>{{"crashed", 2}};
  const nlohmann::json json = written(report);
  EXPECT_EQ(json["bound"], "two-sided");
  EXPECT_EQ(json["feasible"], true);
  EXPECT_EQ(json["e_max"], 0.25);
  EXPECT_EQ(json["e_max_all"], 0.75);
  EXPECT_EQ(json["e_max_squared_bits"], "0x3829f8c4");
  EXPECT_EQ(json["worst_point"], 7);
  EXPECT_EQ(json["excluded"].size(), 1u);
  EXPECT_EQ(json["failures"]["crashed"], 2);
}

// A time is predicted only for a board whose cycles were counted, and says what it is.
TEST(ResultJson, PredictsATimeFromCountedCycles) {
  ResultReport report;
  report.board = board_models().front();
  report.counters = DeviceCounters{};
  EXPECT_TRUE(written(report)["predicted"].is_null());
  report.counters->cycles = 1000;
  const nlohmann::json predicted = written(report)["predicted"];
  EXPECT_EQ(predicted["basis"], "estimated");
  EXPECT_TRUE(predicted["cpu_seconds"].is_null());
}

}  // namespace
}  // namespace emax
