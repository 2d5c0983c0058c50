#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "host/files/nameless_file.h"

namespace emax {

// Records that are given in any order and taken in ascending order, as `<` says. Where the memory
// does not hold them they are sorted in runs, which lie in a file without a name and are merged.
// O(n log n) time.
template <class Record>
class SortedRecords {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  // `memory`: bytes.
  SortedRecords(const NamedInput& input, std::uint64_t memory)
      : input_{input.name},
        most_(std::max<std::size_t>(static_cast<std::size_t>(memory / sizeof(Record)), 4)) {}

  void add(const Record& record) {
    if (held_.empty()) held_.reserve(most_);  // takes no memory before it is used
    held_.push_back(record);
    if (held_.size() == most_) end_run();
  }

  // Calls visit(record) for all, once; then they are gone.
  template <class Visit>
  void take(const Visit& visit) {
    if (runs_.empty()) {
      std::ranges::sort(held_, std::less<>());
      for (const Record& r : held_) visit(r);
    } else {
      if (!held_.empty()) end_run();
      std::vector<Record>().swap(held_);
      merge(visit);
    }
    std::vector<Record>().swap(held_);
    runs_.clear();
    file_.reset();
  }

 private:
  // Of the file, from `next` on; some of it is in memory.
  struct Run {
    std::uint64_t next, end;  // numbers of records in the file
    std::vector<Record> held = {};
    std::size_t at = 0;
  };

  void end_run() {
    std::ranges::sort(held_, std::less<>());
    if (!file_) file_.emplace(input_, "its triangles cannot be sorted");
    const std::uint64_t first = file_->size() / sizeof(Record);
    file_->append({reinterpret_cast<const char*>(held_.data()), held_.size() * sizeof(Record)});
    runs_.push_back({first, first + held_.size()});
    held_.clear();
  }

  // False at the end of the run.
  bool refill(Run& run, std::size_t records) const {
    run.held.resize(static_cast<std::size_t>(std::min<std::uint64_t>(records, run.end - run.next)));
    run.at = 0;
    if (run.held.empty()) return false;
    file_->read(run.next * sizeof(Record),
                {reinterpret_cast<char*>(run.held.data()), run.held.size() * sizeof(Record)});
    run.next += run.held.size();
    return true;
  }

  template <class Visit>
  void merge(const Visit& visit) {
    constexpr std::size_t kFewest = 64;
    const std::size_t block = std::max(most_ / runs_.size(), kFewest);
    const auto later = [this](std::size_t a, std::size_t b) {
      return runs_[b].held[runs_[b].at] < runs_[a].held[runs_[a].at];
    };
    std::vector<std::size_t> heap;  // of runs, the one with the least next record first
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (refill(runs_[i], block)) heap.push_back(i);
    }
    std::ranges::make_heap(heap, later);
    while (!heap.empty()) {
      std::ranges::pop_heap(heap, later);
      Run& run = runs_[heap.back()];
      // As many as come before the next run.
      do {
        visit(run.held[run.at++]);
        if (run.at == run.held.size() && !refill(run, block)) break;
      } while (heap.size() == 1 || !later(heap.back(), heap.front()));
      if (run.held.empty()) {
        heap.pop_back();
      } else {
        std::ranges::push_heap(heap, later);
      }
    }
  }

  NamedInput input_;
  std::size_t most_;  // records in memory
  std::vector<Record> held_;
  std::vector<Run> runs_;
  std::optional<NamelessFile> file_;
};

}  // namespace emax
