#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "testbench/lowered/bench_samples.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

// Of 16 cycles, those in which a sample is offered and those in which a result is taken.
struct Pace {
  std::uint32_t offered, taken;
};
constexpr Pace kPaces[] = {{16, 16}, {16, 4}, {4, 16}, {8, 8}};
// The same for records: all of them at once, or fewer than the samples need.
constexpr std::uint32_t kRecordsOffered[] = {16, 16, 2, 16, 1};
constexpr std::size_t kCyclesOfAPace = 500;
constexpr int kMostCyclesWithoutAResult = 4000;

// The samples of a stream, with their tlast. With a record, the samples up to one with tlast have
// the record of the first of them.
struct StreamSamples {
  std::vector<std::vector<Bits>> samples;
  std::vector<bool> last;
  std::vector<std::size_t> records;  // the first sample of each

  StreamSamples(const StreamBench& bench, const BenchOptions& options, Random& random)
      : samples(drawn_samples(bench.name, bench.model, options)) {
    constexpr std::size_t kSamplesOfALength = 400;
    constexpr std::uint32_t kLengths[] = {16, 1, 2, 60};
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t length = bench.records ? i / kSamplesOfALength % std::size(kLengths) : 0;
      if (i == 0 || last.back()) records.push_back(i);
      last.push_back(random.one_in(kLengths[length]));
      if (!bench.records) continue;
      for (const std::size_t place : bench.records->arguments) {
        samples[i][place] = samples[records.back()][place];
      }
    }
  }
};

class Streams {
 public:
  Streams(const StreamBench& bench, const BenchOptions& options)
      : bench_(bench),
        options_(options),
        random_(named_seed("streams", options.seed)),
        given_(bench, options, random_),
        in_record_(bench.inputs.size(), false) {
    if (!bench.records) return;
    for (const std::size_t place : bench.records->arguments) in_record_[place] = true;
  }

  // Whether every sample gave its result, once and in order.
  bool equal() {
    reset();
    int idle = 0;
    for (std::size_t cycle = 0; received_ < given_.samples.size(); ++cycle) {
      const Pace& pace = kPaces[cycle / kCyclesOfAPace % std::size(kPaces)];
      offer(pace);
      offer_record(kRecordsOffered[cycle / kCyclesOfAPace % std::size(kRecordsOffered)]);
      bench_.streams.m_axis_tready.set(random_.below(16) < pace.taken ? 1 : 0);
      bench_.evaluate(false);
      waits_ = bench_.streams.s_axis_tvalid.get() != 0 && bench_.streams.s_axis_tready.get() == 0;
      if (bench_.streams.s_axis_tvalid.get() != 0 && !waits_) ++accepted_;
      if (!accept_record()) return false;
      const bool given =
          bench_.streams.m_axis_tvalid.get() != 0 && bench_.streams.m_axis_tready.get() != 0;
      if (given && !is_next()) return false;
      idle = given ? 0 : idle + 1;
      if (idle > kMostCyclesWithoutAResult) return fails("no result comes any more");
      bench_.evaluate(true);
    }
    return true;
  }

  std::string records_in_words() const {
    if (!bench_.records) return "";
    return " of " + std::to_string(records_) + " records";
  }

 private:
  void reset() {
    bench_.streams.aresetn.set(0);
    bench_.streams.s_axis_tvalid.set(0);
    bench_.streams.m_axis_tready.set(0);
    if (bench_.records) bench_.records->tvalid.set(0);
    for (int i = 0; i < 8; ++i) bench_.evaluate(i % 2 != 0);
    bench_.streams.aresetn.set(1);
  }

  void set_inputs(const std::vector<Bits>& sample, bool of_record) {
    for (std::size_t i = 0; i < bench_.inputs.size(); ++i) {
      if (in_record_[i] == of_record) bench_.inputs[i].set(sample[i]);
    }
  }

  // An offered sample stays until it is accepted.
  void offer(const Pace& pace) {
    if (waits_) return;
    const bool offers = accepted_ < given_.samples.size() && random_.below(16) < pace.offered;
    bench_.streams.s_axis_tvalid.set(offers ? 1 : 0);
    if (!offers) return;
    set_inputs(given_.samples[accepted_], false);
    bench_.streams.s_axis_tlast.set(given_.last[accepted_] ? 1 : 0);
  }

  // So does a record. Its words are others where none is offered.
  void offer_record(std::uint32_t offered) {
    if (!bench_.records || record_waits_) return;
    const bool offers = records_ < given_.records.size() && random_.below(16) < offered;
    bench_.records->tvalid.set(offers ? 1 : 0);
    const std::size_t other = random_.below(static_cast<std::uint32_t>(given_.samples.size()));
    set_inputs(given_.samples[offers ? given_.records[records_] : other], true);
  }

  bool accept_record() {
    if (!bench_.records) return true;
    const bool offered = bench_.records->tvalid.get() != 0;
    record_waits_ = offered && bench_.records->tready.get() == 0;
    if (offered && !record_waits_) ++records_;
    if (accepted_ == 0) return true;
    const auto after = std::ranges::upper_bound(given_.records, accepted_ - 1);
    return static_cast<std::size_t>(after - given_.records.begin()) <= records_ ||
           fails("a sample is accepted before its record");
  }

  bool is_next() {
    const std::size_t number = received_++;
    if (number >= accepted_) return fails("a result comes that no sample has");
    if (number < static_cast<std::size_t>(options_.late)) return true;
    const std::size_t compared = number - static_cast<std::size_t>(options_.late);
    if ((bench_.streams.m_axis_tlast.get() != 0) != given_.last[compared]) {
      return fails("a result has another tlast than its sample");
    }
    return is_models_result(bench_.name, bench_.model, bench_.outputs, given_.samples[compared],
                            compared, options_.seed);
  }

  bool fails(const char* what) const {
    std::printf("%.*s: stream, seed %llu, after %zu samples: %s\n",
                static_cast<int>(bench_.name.size()), bench_.name.data(),
                static_cast<unsigned long long>(options_.seed), accepted_, what);
    return false;
  }

  const StreamBench& bench_;
  const BenchOptions options_;
  Random random_;
  const StreamSamples given_;
  std::vector<bool> in_record_;
  std::size_t accepted_ = 0, records_ = 0, received_ = 0;
  bool waits_ = false, record_waits_ = false;
};

}  // namespace

int run_stream_bench(const StreamBench& bench, int argc, char** argv) {
  const auto compare = [&](const BenchOptions& options) -> std::optional<std::string> {
    Streams streams(bench, options);
    if (!streams.equal()) return std::nullopt;
    return std::to_string(options.samples) + " samples" + streams.records_in_words() + " of seed " +
           std::to_string(options.seed) + " through the streams";
  };
  return comparison_exit_code(bench.name, argc, argv, compare);
}

}  // namespace emax
