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
// Three digits, never an exponent.
std::string digits(double value);
std::string range(const Spread& spread);

// One way of doing a group's work.
struct Way {
  std::string title;
  double units_per_iteration;
  bool peer = false;               // one of those that the group's ratios may refer to
  std::vector<double> times = {};  // in the group's unit, one entry a round
  std::string not_measured = {};   // why there is none
};

// Ways to do the same work, and what their times are compared with, round by round: the first way,
// or the fastest of the peers in that round.
class Group {
 public:
  enum class Reference { kFirstWay, kFastestPeer };
  enum class Clock { kCpu, kWall };
  using Run = std::function<void(benchmark::State&)>;

  Group(std::string title, std::string unit, double units_per_second,
        Reference reference = Reference::kFirstWay)
      : title_(std::move(title)),
        unit_(std::move(unit)),
        units_per_second_(units_per_second),
        reference_(reference) {}

  // Registers a benchmark whose iteration does `amount` of what the unit counts.
  void add(const std::string& way, double amount, Run run, Clock clock = Clock::kCpu);
  void add_peer(const std::string& way, double amount, Run run);
  // A peer that is measured by others; they record() a time of it each round, or say why not.
  void add_foreign_peer(const std::string& way);
  void not_measured(const std::string& way, std::string why);
  // The text above the table.
  void describe(std::string text) { text_ = std::move(text); }

  // The time of one iteration of `way`. False when the group has no such way.
  bool record(std::string_view way, double seconds);
  bool record_benchmark(const std::string& benchmark_name, double seconds);

  const std::string& title() const { return title_; }
  const std::vector<Way>& ways() const { return ways_; }
  // Nothing when it was not measured in this run.
  std::optional<Spread> time(std::string_view way) const;
  // Time of `way` over that of `reference`, of every round.
  std::vector<double> ratios(std::string_view way, std::string_view reference) const;
  // How many times the fastest peer of each round took the time of `way`.
  std::vector<double> speedups(std::string_view way) const;
  // Time of `way` over that of the first way; nothing when one of them was filtered out.
  std::optional<Spread> ratio(std::string_view way) const;
  void write(std::ostream& out) const;

 private:
  Way* find(std::string_view way);
  const Way* find(std::string_view way) const;

  std::string title_, unit_, text_;
  double units_per_second_;
  Reference reference_;
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

// A benchmark that does `work` in each iteration.
template <class Work>
auto repeat(Work work) {
  return [work](benchmark::State& state) {
    for ([[maybe_unused]] const auto _ : state) {
      auto result = work();
      benchmark::DoNotOptimize(result);
    }
  };
}

}  // namespace emax::benchmarks
