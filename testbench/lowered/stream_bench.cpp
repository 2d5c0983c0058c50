#include <cstdio>
#include <deque>
#include <stdexcept>

#include "testbench/lowered/bench_samples.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

// Of 16 cycles, those in which a sample is offered and those in which a result is taken.
struct Pace {
  std::uint32_t offered, taken;
};
constexpr Pace kPaces[] = {{16, 16}, {16, 4}, {4, 16}, {8, 8}};
constexpr std::size_t kCyclesOfAPace = 500;
constexpr int kMostCyclesWithoutAResult = 4000;

class Streams {
 public:
  Streams(const StreamBench& bench, const BenchOptions& options)
      : bench_(bench),
        options_(options),
        samples_(drawn_samples(bench.name, bench.model, options)),
        random_(named_seed("streams", options.seed)) {
    for (std::size_t i = 0; i < samples_.size(); ++i) last_.push_back(random_.one_in(16));
  }

  // Whether every sample gave its result, once and in order.
  bool equal() {
    reset();
    int idle = 0;
    for (std::size_t cycle = 0; received_ < samples_.size(); ++cycle) {
      const Pace& pace = kPaces[cycle / kCyclesOfAPace % std::size(kPaces)];
      offer(pace);
      bench_.streams.m_axis_tready.set(random_.below(16) < pace.taken ? 1 : 0);
      bench_.evaluate(false);
      waits_ = bench_.streams.s_axis_tvalid.get() != 0 && bench_.streams.s_axis_tready.get() == 0;
      if (bench_.streams.s_axis_tvalid.get() != 0 && !waits_) ++accepted_;
      const bool given =
          bench_.streams.m_axis_tvalid.get() != 0 && bench_.streams.m_axis_tready.get() != 0;
      if (given && !is_next()) return false;
      idle = given ? 0 : idle + 1;
      if (idle > kMostCyclesWithoutAResult) return fails("no result comes any more");
      bench_.evaluate(true);
    }
    return true;
  }

 private:
  void reset() {
    bench_.streams.aresetn.set(0);
    bench_.streams.s_axis_tvalid.set(0);
    bench_.streams.m_axis_tready.set(0);
    for (int i = 0; i < 8; ++i) bench_.evaluate(i % 2 != 0);
    bench_.streams.aresetn.set(1);
  }

  // An offered sample stays until it is accepted.
  void offer(const Pace& pace) {
    if (waits_) return;
    const bool offers = accepted_ < samples_.size() && random_.below(16) < pace.offered;
    bench_.streams.s_axis_tvalid.set(offers ? 1 : 0);
    if (!offers) return;
    for (std::size_t i = 0; i < bench_.inputs.size(); ++i) {
      bench_.inputs[i].set(samples_[accepted_][i]);
    }
    bench_.streams.s_axis_tlast.set(last_[accepted_] ? 1 : 0);
  }

  bool is_next() {
    const std::size_t number = received_++;
    if (number >= accepted_) return fails("a result comes that no sample has");
    if (number < static_cast<std::size_t>(options_.late)) return true;
    const std::size_t compared = number - static_cast<std::size_t>(options_.late);
    if ((bench_.streams.m_axis_tlast.get() != 0) != last_[compared]) {
      return fails("a result has another tlast than its sample");
    }
    return is_models_result(bench_.name, bench_.model, bench_.outputs, samples_[compared], compared,
                            options_.seed);
  }

  bool fails(const char* what) const {
    std::printf("%.*s: stream, seed %llu, after %zu samples: %s\n",
                static_cast<int>(bench_.name.size()), bench_.name.data(),
                static_cast<unsigned long long>(options_.seed), accepted_, what);
    return false;
  }

  const StreamBench& bench_;
  const BenchOptions options_;
  const std::vector<std::vector<Bits>> samples_;
  Random random_;
  std::vector<bool> last_;
  std::size_t accepted_ = 0, received_ = 0;
  bool waits_ = false;
};

}  // namespace

int run_stream_bench(const StreamBench& bench, int argc, char** argv) {
  try {
    const BenchOptions options = bench_options(argc, argv);
    if (options.check != BenchCheck::kResults) {
      throw std::invalid_argument("the streams' samples are those of bench; ask it");
    }
    if (!Streams(bench, options).equal()) return 1;
    std::printf("%.*s: %d samples of seed %llu through the streams, all equal\n",
                static_cast<int>(bench.name.size()), bench.name.data(), options.samples,
                static_cast<unsigned long long>(options.seed));
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(bench.name.size()), bench.name.data(),
                 error.what());
    return 2;
  }
}

}  // namespace emax
