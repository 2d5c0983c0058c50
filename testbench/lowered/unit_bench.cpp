#include <algorithm>
#include <deque>
#include <optional>
#include <string>

#include "testbench/lowered/bench_samples.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

constexpr std::size_t kSlots = 16;

// What a slot holds, as the unit's first lines permit its use: a record may be used in the cycle
// after the one that writes it, and is no more written until last_read cycles after its last use.
struct RecordSlot {
  std::vector<Bits> sample;  // one that has the record
  bool used = false;         // samples still meet the record
  int last_use = 0;
};

class Unit {
 public:
  Unit(const UnitBench& bench, const BenchOptions& options)
      : bench_(bench),
        options_(options),
        samples_(drawn_samples(bench.name, bench.model, options)),
        random_(named_seed("slots", options.seed)),
        slots_(kSlots) {
    std::vector<bool> in_record(bench.model.arguments.size(), false);
    for (const std::size_t place : bench.record) in_record[place] = true;
    for (std::size_t i = 0; i < in_record.size(); ++i) {
      if (!in_record[i]) others_.push_back(i);
    }
  }

  bool equal() {
    std::size_t given = 0, received = 0;
    for (int cycle = 0; received < samples_.size(); ++cycle) {
      const std::size_t used = given < samples_.size() ? use_slot() : kSlots;
      if (used < kSlots) give(given++, used, cycle);
      write_slot(used, cycle);
      bench_.evaluate(false);
      if (!due_.empty() && due_.front().cycle + options_.late == cycle) {
        if (!is_models_result(bench_.name, bench_.model, bench_.outputs, due_.front().sample,
                              received++, options_.seed)) {
          return false;
        }
        due_.pop_front();
      }
      bench_.evaluate(true);
    }
    return true;
  }

  std::size_t records() const { return records_; }

 private:
  struct Due {
    int cycle;
    std::vector<Bits> sample;
  };

  // One of the slots with a record that samples meet; the newest of them more often than others.
  std::size_t use_slot() {
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < kSlots; ++i) {
      if (slots_[i].used) usable.push_back(i);
    }
    if (usable.empty()) return kSlots;
    const std::size_t any = usable[random_.below(static_cast<std::uint32_t>(usable.size()))];
    return slots_[newest_].used && random_.one_in(3) ? newest_ : any;
  }

  void give(std::size_t number, std::size_t used, int cycle) {
    std::vector<Bits> sample = samples_[number];
    for (const std::size_t place : bench_.record) sample[place] = slots_[used].sample[place];
    for (std::size_t i = 0; i < others_.size(); ++i) bench_.inputs[i].set(sample[others_[i]]);
    bench_.slots.slot.set(used);
    slots_[used].last_use = cycle;
    slots_[used].used = !random_.one_in(8);
    due_.push_back({cycle + bench_.latency, std::move(sample)});
  }

  // A free slot that may be written is written in every other cycle, the first ones first.
  void write_slot(std::size_t used, int cycle) {
    std::size_t free = kSlots;
    for (std::size_t i = kSlots; i-- > 0;) {
      const RecordSlot& slot = slots_[i];
      const bool rests = !slot.sample.empty() && cycle <= slot.last_use + bench_.last_read;
      if (!slot.used && i != used && !rests) free = i;
    }
    const bool writes = free < kSlots && random_.one_in(2);
    bench_.slots.write_enable.set(writes ? 1 : 0);
    // Where nothing is written, words come that no record has, and any slot.
    bench_.slots.write_slot.set(writes ? free : random_.below(kSlots));
    const std::vector<Bits>& sample =
        samples_[random_.below(static_cast<std::uint32_t>(samples_.size()))];
    bench_.write_record(words_of(sample));
    if (!writes) return;
    slots_[free] = {sample, true, cycle};
    newest_ = free;
    ++records_;
  }

  // The record's words, its fields without gaps.
  std::vector<Word> words_of(const std::vector<Bits>& sample) const {
    std::vector<Word> words;
    std::size_t at = 0;
    for (const std::size_t place : bench_.record) {
      const auto width = static_cast<std::size_t>(bench_.model.arguments[place].width);
      words.resize((at + width + 31) / 32, 0);
      for (std::size_t bit = 0; bit < width; ++bit, ++at) {
        if ((sample[place] >> bit & 1u) != 0) words[at / 32] |= Word{1} << at % 32;
      }
    }
    return words;
  }

  const UnitBench& bench_;
  const BenchOptions options_;
  const std::vector<std::vector<Bits>> samples_;
  Random random_;
  std::vector<RecordSlot> slots_;
  std::vector<std::size_t> others_;  // places of the arguments that no record has
  std::deque<Due> due_;
  std::size_t newest_ = 0, records_ = 0;
};

}  // namespace

int run_unit_bench(const UnitBench& bench, int argc, char** argv) {
  const auto compare = [&](const BenchOptions& options) -> std::optional<std::string> {
    Unit unit(bench, options);
    if (!unit.equal()) return std::nullopt;
    return std::to_string(options.samples) + " samples that meet " +
           std::to_string(unit.records()) + " records of seed " + std::to_string(options.seed);
  };
  return comparison_exit_code(bench.name, argc, argv, compare);
}

}  // namespace emax
