// Verilator's coverage by module: coverage.dat files, summed over all instances of a module.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace emax {

enum class CoverageKind : std::uint8_t { kLine, kBranch, kToggle };
constexpr std::size_t kCoverageKinds = 3;

struct CoverageCount {
  std::uint64_t points = 0, covered = 0;
};

// One point that was never hit: "fp_add.sv:17 toggle carry[3]".
struct CoverageReport {
  std::map<std::string, std::array<CoverageCount, kCoverageKinds>> modules;
  std::array<CoverageCount, kCoverageKinds> all;
  std::vector<std::string> missed;
  std::map<std::string, std::uint64_t> excepted;  // points, by the exception's reason
};

// Throws Error for a file that cannot be read or holds no points.
CoverageReport read_coverage(const std::vector<std::string>& files);

// Share in percent; 100 where there is no point.
double percent(const CoverageCount& count);

// Counts of all kinds of points together.
double percent_of_all(const CoverageReport& report);

// The share in percent of its design's points that each test reaches: lines of NAME, tab, SHARE.
// Both functions throw Error where the file cannot be written or read.
void write_test_coverage(const std::map<std::string, double>& shares, const std::string& file);
std::map<std::string, double> read_test_coverage(const std::string& file);

void print_coverage(const CoverageReport& report, bool list_missed);

}  // namespace emax
