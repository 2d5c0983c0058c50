#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/geometry/point_cloud.h"
#include "host/report/deviation_statistics.h"
#include "host/report/report_geometry.h"

namespace emax {

// The content of `--report`, in the cloud's unit. Schema emax-report-1.

// What a command says in a line of its output, or of a parameter.
struct NamedText {
  std::string name, text;
};

struct ReportInput {
  std::string name;          // what it is: "cloud", "mesh", "reference"
  std::string file, sha256;  // as it was read
};

struct ReportedPoint {
  std::uint32_t point;  // the file's index
  Point position;
  double deviation;
  std::uint32_t triangle;  // the nearest
};

// What a report shows of a cloud beside a mesh, measured once. Statistics, histogram and worst
// points speak of the points that are not excluded.
struct ReportMeasurement {
  bool is_signed = false;
  DeviationStatistics statistics;
  DeviationHistogram histogram;
  std::vector<ReportedPoint> worst;     // the farthest first; their distances are certified
  std::vector<ReportedPoint> excluded;  // the farthest first, at most kMostExcludedShown
  std::size_t excluded_count = 0;
  std::vector<LeftOut> left_out;  // of the file
  ReportGeometry geometry;
  std::string page_picture, picture;  // PNG; empty: not asked for
};

inline constexpr std::size_t kWorstShown = 20;
inline constexpr std::size_t kMostExcludedShown = 1000;

struct ReportCertificate {
  std::string file, text;
  std::string verify;  // the command that verifies it
};

struct ReportCheck {
  std::string claim;
  bool holds;
  std::string text;
};

struct ReportEvaluation {
  std::uint64_t index;
  std::optional<double> seconds;           // when its result was known
  std::optional<std::uint64_t> triangles;  // nothing where it failed
  bool feasible;
};

struct ReportCurvePoint {
  double epsilon;
  std::optional<std::size_t> triangles;  // nothing where no mesh keeps it
};

struct ReportTime {
  std::string name;
  double seconds;
};

struct ReportData {
  std::string command;  // "optimize", ...
  std::string program;  // "emax 0.1.0"
  std::string title;
  std::optional<std::string> unit;
  std::optional<bool> within;
  std::string verdict;  // a sentence
  std::optional<double> epsilon, e_max;
  std::optional<double> back;  // the greatest distance of the mesh from a reference
  double width = 0;
  std::vector<NamedText> facts;
  std::vector<ReportInput> provenance;
  std::vector<NamedText> parameters;
  std::optional<ReportCertificate> certificate;
  std::optional<std::vector<ReportCheck>> checks;
  std::optional<std::vector<ReportEvaluation>> search;
  std::optional<std::vector<ReportCurvePoint>> curve;
  std::vector<ReportTime> times;
  ReportMeasurement measured;
};

// The JSON of a report, in one line. All that differs between runs of the same command on the same
// files stands at its end: search and times. Bytes that are not UTF-8 become U+FFFD.
std::string report_json(const ReportData& report);

}  // namespace emax
