#pragma once

#include <benchmark/benchmark.h>

#include <deque>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace emax::benchmarks {

struct Spread {
  double median, least, greatest;
};

Spread spread_of(std::vector<double> values);

// One way of doing a group's work; CPU time in the group's unit, one entry a round.
struct Way {
  std::string title;
  double units_per_iteration;
  std::vector<double> times;
};

// Ways to do the same work. The first is what the others are compared with, round by round.
class Group {
 public:
  Group(std::string title, std::string unit, double units_per_second)
      : title_(std::move(title)), unit_(std::move(unit)), units_per_second_(units_per_second) {}

  // Registers a benchmark whose iteration does `amount` of what the unit counts.
  void add(const std::string& way, double amount, std::function<void(benchmark::State&)> run);
  // The text above the table.
  void describe(std::string text) { text_ = std::move(text); }

  bool record(const std::string& benchmark_name, double seconds);
  // Time of `way` over that of the first way; nothing when one of them was filtered out.
  std::optional<Spread> ratio(const std::string& way) const;
  void write(std::ostream& out) const;

 private:
  std::optional<Spread> ratio(const Way& way) const;

  std::string title_, unit_, text_;
  double units_per_second_;
  std::vector<Way> ways_;
};

// Groups stay where they are: the benchmarks' functions may refer to them.
using Groups = std::deque<Group>;

// Prints as usual and records every run in its group.
class RecordingReporter : public benchmark::ConsoleReporter {
 public:
  explicit RecordingReporter(Groups& groups) : groups_(groups) {}
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;

  bool failed() const { return failed_; }
  bool empty() const { return empty_; }

 private:
  Groups& groups_;
  bool context_shown_ = false, failed_ = false, empty_ = true;
};

// Every form of the squared distance of a pair, with the points in random order (first group) and
// with neighbours in a row (second).
constexpr const char* kEricsonFloat = "Ericson from the corners, float";
constexpr const char* kLiteral = "the paper's literal (u, v) form, float";
constexpr const char* kVisibleEdge = "visible-edge form (the kernel's), float";
std::string simd_way(std::string_view target);
void add_pair_groups(Groups& groups);

// e_max of the bunny's points. Throws Error when the ways disagree on it.
void add_search_groups(Groups& groups);

}  // namespace emax::benchmarks
