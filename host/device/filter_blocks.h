#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hls/kernel/filter_words.h"
#include "host/block_search/evaluator.h"
#include "host/device/stored_items.h"

namespace emax {

// The points and records of a search in the filter's numbers, and blocks of them as commands of a
// filtering core. Behind a board's store a point or record is sent once and named from then on; the
// points of the next search are still there if they are the same, those of the next mesh's records
// that are. Without a store every block carries its points and records.
class FilterBlocks {
 public:
  // A store of no words is none. One that does not hold a block's points is not used.
  explicit FilterBlocks(std::size_t store_words);

  bool stores() const { return scratch_.has_value(); }
  // As Evaluator's.
  void lay_out(std::span<const std::uint32_t> order) { order_.assign(order.begin(), order.end()); }
  void begin(std::span<const Vector3<float>> points,
             std::span<const TriangleRecord<float>> records);

  // Of the units of the present search: lengths are multiplied by 2^exponent().
  int exponent() const { return exponent_; }
  // Whether the record has numbers of the filter.
  bool has(std::uint32_t record) const { return record_places_[record] != kNowhere; }

  // The block's points in the order in which append() sends them, which is that of their results.
  void arrange(std::vector<std::uint32_t>& points) const;
  // Appends the block, whose points are arranged. It has a record of the filter.
  void append(const Block& block, std::vector<Word>& words);

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  void append_points(std::span<const std::uint32_t> points, std::vector<Word>& words);
  void append_records(std::span<const std::uint32_t> candidates, std::vector<Word>& words);

  std::optional<std::size_t> scratch_;  // the address of a block's points that have no place
  std::vector<std::uint32_t> order_;
  int exponent_ = 0;
  std::vector<std::uint32_t> point_places_, record_places_;  // of each, among the items
  StoredItems points_{kFilterPointWords}, records_{kFilterRecordWords};
};

}  // namespace emax
