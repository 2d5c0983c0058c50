// The page beside readers of its own: a JSON parser, zlib and a decoder of base64.
#include "host/report/report_page.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "host/report/report_measurement.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using nlohmann::json;

constexpr std::string_view kTemplate = "<html><body>\n<!--emax:report-->\n</body></html>\n";
constexpr const char* kHostile = "</script><script>alert(1)</script><!--\"&'\xff.ply";

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return "no " + from;
  const std::size_t at = begin + from.size();
  return text.substr(at, text.find(to, at) - at);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

std::string decoded(const std::string& base64) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int held = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(kDigits.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xff);
  }
  return bytes;
}

std::string inflated(const std::string& stream, std::size_t size) {
  std::string bytes(size + 1, '\0');
  uLongf held = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &held,
                       reinterpret_cast<const Bytef*>(stream.data()), stream.size()),
            Z_OK);
  bytes.resize(held);
  return bytes;
}

ReportData report_of(const Stimulus& s, std::optional<double> epsilon) {
  ReportData report;
  report.command = "error";
  report.title = kHostile;
  report.verdict = "Within tolerance.";
  report.facts = {{"mesh", kHostile}};
  report.epsilon = epsilon;
  report.times = {{"e_max", 0.25}};
  PointCloud cloud;
  cloud.points = s.cloud;
  report.measured = measure_for_report(cloud, s.mesh(), {5, 6}, epsilon, {}, 2);
  return report;
}

json json_of(const std::string& page) {
  return json::parse(between(page, "id=\"emax-data\">", "</script>"), nullptr, false);
}

TEST(ReportPage, HoldsTheReportInPlaceOfTheMarker) {
  const Stimulus s = bumpy_sphere(6, 8, 2000, 12);
  const ReportData report = report_of(s, 0.5);
  const std::string page = report_page(report, kTemplate);
  EXPECT_EQ(page.find(kReportMarker), std::string::npos);
  EXPECT_TRUE(page.starts_with("<html><body>\n<script type=\"application/json\""));
  EXPECT_TRUE(page.ends_with("\">\n</body></html>\n"));
  const json data = json_of(page);
  ASSERT_TRUE(data.is_object());
  EXPECT_EQ(data.at("schema"), "emax-report-1");
  EXPECT_EQ(data.at("geometry").at("points"), 1998);
  EXPECT_EQ(data.at("geometry").at("points_of"), 1998);
  EXPECT_EQ(data.at("excluded_count"), 2);
  EXPECT_EQ(data.at("worst").size(), kWorstShown);
  EXPECT_EQ(data.at("signed"), true);
  EXPECT_EQ(data.at("unit"), nullptr);
  EXPECT_EQ(data.at("checks"), nullptr);
  const std::string geometry = report.measured.geometry.bytes;
  EXPECT_EQ(inflated(decoded(between(page, "id=\"emax-geometry\">", "<")), geometry.size()),
            geometry);
  EXPECT_EQ(decoded(between(page, "data:image/png;base64,", "\"")), report.measured.page_picture);
  EXPECT_TRUE(report.measured.page_picture.starts_with("\x89PNG"));
}

TEST(ReportPage, TimesStandAtTheEnd) {
  const Stimulus s = bumpy_sphere(6, 8, 100, 13);
  ReportData report = report_of(s, 0.5);
  const std::string once = report_json(report);
  report.times = {{"e_max", 17}};
  report.search = {{{0, 2.0, 10, true}}};
  const std::string again = report_json(report);
  const std::size_t end = once.find("\"search\"");
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(once.substr(0, end), again.substr(0, end));
}

bool is_escaped(const std::string& page) {
  const json data = json_of(page);
  return count(page, "</script>") == 2 && count(page, "<!--") == 0 && !data.is_discarded() &&
         data.at("facts").at(0).at("text") ==
             "</script><script>alert(1)</script><!--\"&'\xef\xbf\xbd.ply" &&
         between(page, "alt=\"", "\"").starts_with("&lt;/script>");
}

TEST(ReportPage, HostileNamesStayText) {
  const Stimulus s = bumpy_sphere(6, 8, 100, 14);
  EXPECT_TRUE(is_escaped(report_page(report_of(s, 0.5), kTemplate)));
}

TEST(ReportPageFault, TextThatEndsItsElementIsCaught) {
  const DeliberateFault fault(Fault::kReportUnescaped);
  const Stimulus s = bumpy_sphere(6, 8, 100, 14);
  EXPECT_FALSE(is_escaped(report_page(report_of(s, 0.5), kTemplate)));
}

TEST(ReportPage, NeedsTheMarkerOnce) {
  const ReportData report;
  EXPECT_THROW(report_page(report, "<html></html>"), std::logic_error);
  EXPECT_THROW(report_page(report, std::string(kTemplate) + std::string(kTemplate)),
               std::logic_error);
  EXPECT_NO_THROW(report_page(report));
}

// A megabyte, and 12 bytes for each point and vertex that is shown.
TEST(ReportPage, IsSmall) {
  for (const std::size_t points : {100u, 40'000u, 400'000u}) {
    const Stimulus s = bumpy_sphere(20, 30, points, 15);
    const ReportData report = report_of(s, std::nullopt);
    const ReportGeometry& g = report.measured.geometry;
    EXPECT_LE(report_page(report).size(), 1'000'000 + 12 * (g.points + g.vertices)) << points;
  }
}

TEST(ReportMeasurement, WithoutATolerancesReachesToTheFarthestPoint) {
  const Stimulus s = bumpy_sphere(6, 8, 500, 16);
  const ReportMeasurement m = report_of(s, std::nullopt).measured;
  EXPECT_EQ(m.histogram.below + m.histogram.above, 0u);
  EXPECT_EQ(std::abs(m.worst.front().deviation), m.histogram.edges.back());
  EXPECT_FALSE(m.statistics.against_epsilon);
  for (std::size_t i = 1; i < m.worst.size(); ++i) {
    EXPECT_GE(std::abs(m.worst[i - 1].deviation), std::abs(m.worst[i].deviation));
  }
}

TEST(ReportMeasurement, OfAMeshThroughEveryPointHasALegend) {
  Stimulus s = bumpy_sphere(6, 8, 0, 17);
  s.cloud = s.vertices;
  const ReportMeasurement m = report_of(s, std::nullopt).measured;
  EXPECT_GT(m.histogram.edges.back(), 0);
  EXPECT_GT(m.geometry.deviation_step, 0);
}

}  // namespace
}  // namespace emax::test
