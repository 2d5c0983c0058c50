#include "testbench/cosimulation/coverage_report.h"

#include <cstdio>
#include <fstream>
#include <regex>

#include "sw_model/base/error.h"

namespace emax {
namespace {

// Points that are not counted, each with its reason.
struct Exception {
  std::regex module, point;  // point: "kind signal"
  const char* reason;
};

const std::vector<Exception>& exceptions() {
  static const std::vector<Exception> all = {
      {std::regex("delay_line|valid_line"),
       std::regex("toggle (stage|words|line|place|next|word)\\b.*"),
       "storage of delay lines: a copy of the value that enters"},
      {std::regex("block_memory"), std::regex("toggle words\\b.*"),
       "storage of block memories: a copy of the value that enters"},
      {std::regex("emax_element|emax_maximum|worst_point"),
       std::regex("toggle (m_axis_worst_tdata\\[(4[2-9]|5.|6.)\\]|"
                  "(so_far|next|result|greater)_index\\[(1.|2.|3.)\\])"),
       "an index's bits above the 10 that points have: zero"},
      {std::regex("emax_.*|mantissa_square|fp_square|worst_point|running_minimum|ring_memory|"
                  "block_memory"),
       std::regex(
           "toggle (square|square_early|exact|off_plane|in_plane|.*squared_distance|"
           ".*squared_distance_choice|residual.._choice|.*_magnitude(_2)?|in_plane_square(_2)?|"
           "off_plane_at_[0-9]+|minimum|smaller|next|so_far|result|greater|worst|"
           "m_axis_nearest_tdata|m_axis_worst_tdata|m_axis_tdata|push_data|stored|"
           "write_data)\\[(31|47)\\]"),
       "the sign of a square, a magnitude or what relu gives: zero"},
      {std::regex("fp_add"),
       std::regex("toggle (total_[0-9]+[nw]?\\[[0-3]\\]|smaller_0b\\[[01]\\])"),
       "places below the sticky bit in words of 32 bits: zero"},
      {std::regex("mantissa_square|fp_square"), std::regex("toggle (exact|square)\\[1\\]"),
       "the second bit of a square: zero"},
      {std::regex("emax_distance_unit"), std::regex("toggle unused_parts"),
       "names what a tool would call unused"},
      {std::regex("worst_point"), std::regex("line if"), "a branch of the mutation build"},
  };
  return all;
}

const char* exception_of(const std::string& module, const std::string& point) {
  for (const Exception& e : exceptions()) {
    if (std::regex_match(module, e.module) && std::regex_match(point, e.point)) return e.reason;
  }
  return nullptr;
}

// The value of `key` in a line's name, which is a sequence of \1key\2value.
std::string field(const std::string& name, const std::string& key) {
  const std::string mark = "\1" + key + "\2";
  const std::size_t at = name.find(mark);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + mark.size();
  return name.substr(begin, name.find('\1', begin) - begin);
}

constexpr std::array<const char*, kCoverageKinds> kKinds = {"line", "branch", "toggle"};

struct CoveragePoint {
  std::string module, name, place;
  std::size_t kind;
  std::uint64_t hits = 0;
};

void read_file(const std::string& file, std::map<std::string, CoveragePoint>& points) {
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read; write it with --coverage first");
  static const std::regex parameters("__.*$");
  for (std::string line; std::getline(in, line);) {
    const std::size_t end = line.rfind('\'');
    if (!line.starts_with("C '") || end < 3) continue;
    const std::string name = line.substr(3, end - 3), page = field(name, "page");
    const std::size_t slash = page.find('/');
    for (std::size_t kind = 0; kind < kCoverageKinds; ++kind) {
      if (page.substr(0, slash) != std::string("v_") + kKinds[kind]) continue;
      const std::string source = field(name, "f");
      CoveragePoint point;
      point.module = std::regex_replace(page.substr(slash + 1), parameters, "");
      point.kind = kind;
      point.name = std::string(kKinds[kind]) + " " + field(name, "o");
      point.place = source.substr(source.rfind('/') + 1) + ":" + field(name, "l");
      CoveragePoint& known =
          points[point.module + "\1" + point.place + "\1" + field(name, "n") + "\1" + point.name];
      point.hits = known.hits + std::stoull(line.substr(end + 1));
      known = point;
    }
  }
}

void print_line(const std::string& name, const std::array<CoverageCount, kCoverageKinds>& counts) {
  std::printf("%-22s", name.c_str());
  for (const CoverageCount& count : counts) {
    std::printf("  %6llu %6.2f %%", static_cast<unsigned long long>(count.points), percent(count));
  }
  std::printf("\n");
}

}  // namespace

double percent(const CoverageCount& count) {
  return count.points == 0
             ? 100
             : 100 * static_cast<double>(count.covered) / static_cast<double>(count.points);
}

double percent_of_all(const CoverageReport& report) {
  CoverageCount sum;
  for (const CoverageCount& count : report.all) {
    sum.points += count.points;
    sum.covered += count.covered;
  }
  return percent(sum);
}

void write_test_coverage(const std::map<std::string, double>& shares, const std::string& file) {
  std::ofstream out(file);
  for (const auto& [name, share] : shares) out << name << '\t' << share << '\n';
  out.close();
  if (!out) throw Error(file + ": cannot be written");
}

std::map<std::string, double> read_test_coverage(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read; emax_coverage writes it");
  std::map<std::string, double> shares;
  for (std::string line; std::getline(in, line);) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos) throw Error(file + ": '" + line + "' has no tab");
    shares[line.substr(0, tab)] = std::stod(line.substr(tab + 1));
  }
  return shares;
}

CoverageReport read_coverage(const std::vector<std::string>& files) {
  std::map<std::string, CoveragePoint> points;
  for (const std::string& file : files) read_file(file, points);
  if (points.empty()) throw Error(files.front() + ": holds no coverage points");
  CoverageReport report;
  for (const auto& [key, point] : points) {
    // An excepted point that was reached counts.
    const char* reason = point.hits > 0 ? nullptr : exception_of(point.module, point.name);
    if (reason != nullptr) {
      ++report.excepted[reason];
      continue;
    }
    for (CoverageCount* count :
         {&report.modules[point.module][point.kind], &report.all[point.kind]}) {
      ++count->points;
      count->covered += point.hits > 0 ? 1 : 0;
    }
    if (point.hits == 0)
      report.missed.push_back(point.module + " " + point.place + " " + point.name);
  }
  return report;
}

void print_coverage(const CoverageReport& report, bool list_missed) {
  std::printf("%-22s  %15s  %15s  %15s\n", "module", "lines", "branches", "toggles");
  for (const auto& [module, counts] : report.modules) print_line(module, counts);
  print_line("all", report.all);
  for (const auto& [reason, points] : report.excepted) {
    std::printf("excepted: %llu points, %s\n", static_cast<unsigned long long>(points),
                reason.c_str());
  }
  if (!list_missed) return;
  for (const std::string& point : report.missed) std::printf("missed: %s\n", point.c_str());
}

}  // namespace emax
