#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "host/files/nameless_file.h"

namespace emax {

// Records that do not fit into memory, in bins that are numbered from 0. Each bin keeps its last
// block of records in memory, and the others in one file without a name.
template <class Record>
class RecordBins {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  // `memory`: bytes for the last blocks of `expected_bins` together; a block has 4 to 64 KiB.
  RecordBins(const NamedInput& input, std::size_t expected_bins, std::uint64_t memory)
      : file_(NamedInput{input.name}, kBinsCannotBeWritten),
        block_(records_of_a_block(expected_bins, memory)) {}

  void add(std::size_t bin, const Record& record) {
    if (bin >= bins_.size()) bins_.resize(bin + 1);
    Bin& b = bins_[bin];
    if (b.last.empty()) b.last.reserve(block_);
    b.last.push_back(record);
    if (b.last.size() < block_) return;
    b.blocks.push_back(file_.size());
    file_.append({reinterpret_cast<const char*>(b.last.data()), block_ * sizeof(Record)});
    b.last.clear();
  }

  std::size_t bins() const { return bins_.size(); }
  std::uint64_t size(std::size_t bin) const {
    return bin < bins_.size() ? bins_[bin].blocks.size() * block_ + bins_[bin].last.size() : 0;
  }

  // Those from `first` on, in the order in which they came. Several threads may read at a time.
  std::vector<Record> read(std::size_t bin, std::uint64_t first, std::size_t count) const {
    std::vector<Record> records, held;
    records.reserve(count);
    while (records.size() < count) {
      const std::uint64_t at = first + records.size();
      read_block(bin, at / block_, held);
      const std::span<const Record> from = std::span(held).subspan(at % block_);
      const std::size_t taken = std::min(from.size(), count - records.size());
      records.insert(records.end(), from.begin(),
                     from.begin() + static_cast<std::ptrdiff_t>(taken));
    }
    return records;
  }
  std::vector<Record> read(std::size_t bin) const {
    return read(bin, 0, static_cast<std::size_t>(size(bin)));
  }

  // Calls visit(record) for those of a bin. It may add to other bins.
  template <class Visit>
  void for_each(std::size_t bin, const Visit& visit) const {
    std::vector<Record> held;
    const std::uint64_t count = size(bin);
    for (std::uint64_t first = 0; first < count; first += block_) {
      read_block(bin, first / block_, held);
      for (const Record& r : held) visit(r);
    }
  }

 private:
  static constexpr const char* kBinsCannotBeWritten = "its triangles cannot be sorted";

  struct Bin {
    std::vector<std::uint64_t> blocks;  // their offsets
    std::vector<Record> last;
  };

  static std::size_t records_of_a_block(std::size_t bins, std::uint64_t memory) {
    constexpr std::uint64_t kLeast = 1 << 12, kMost = 1 << 16;
    const std::uint64_t bytes = std::clamp(memory / std::max<std::size_t>(bins, 1), kLeast, kMost);
    return static_cast<std::size_t>(bytes / sizeof(Record));
  }

  void read_block(std::size_t bin, std::uint64_t number, std::vector<Record>& to) const {
    const Bin& b = bins_[bin];
    if (number >= b.blocks.size()) {
      to = b.last;
      return;
    }
    to.resize(block_);
    file_.read(b.blocks[static_cast<std::size_t>(number)],
               {reinterpret_cast<char*>(to.data()), block_ * sizeof(Record)});
  }

  NamelessFile file_;
  std::size_t block_;  // records
  std::vector<Bin> bins_;
};

}  // namespace emax
