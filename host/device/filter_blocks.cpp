#include "host/device/filter_blocks.h"

#include <algorithm>
#include <numeric>

#include "sw_model/model/fixed_filter.h"

namespace emax {
namespace {

constexpr std::size_t kScratchWords = kMaxBlockPoints * kFilterPointWords;

// How many items of `size` words fit.
std::size_t fitting(std::size_t words, std::size_t size) { return words / size; }

}  // namespace

FilterBlocks::FilterBlocks(std::size_t store_words) {
  if (store_words >= 2 * kScratchWords) scratch_ = store_words - kScratchWords;
}

void FilterBlocks::begin(std::span<const Vector3<float>> points,
                         std::span<const TriangleRecord<float>> records) {
  exponent_ = filter_exponent(points, records, kFilterBits);
  if (order_.size() != points.size()) {
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0u);
  }
  point_places_.resize(points.size());
  std::vector<Word> point_words(points.size() * kFilterPointWords);
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    point_places_[order_[place]] = place;
    pack_filter_point(filter_point<kFilterBits>(points[order_[place]], exponent_),
                      &point_words[place * kFilterPointWords]);
  }
  record_places_.assign(records.size(), kNowhere);
  std::vector<Word> record_words;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto record = filter_record<kFilterBits>(records[i], exponent_);
    if (!record) continue;
    record_places_[i] = next++;
    record_words.resize(next * kFilterRecordWords);
    pack_filter_record(*record, &record_words[record_words.size() - kFilterRecordWords]);
  }
  // Where not everything fits, points get what the records leave, and half of the store at least.
  const std::size_t words = scratch_.value_or(0);
  const std::size_t for_points = std::max(words / 2, words - std::min(words, record_words.size()));
  const std::size_t kept = std::min(points.size(), fitting(for_points, kFilterPointWords));
  const std::size_t base = kept * kFilterPointWords;
  points_.set(std::move(point_words), 0, kept);
  records_.set(std::move(record_words), base, fitting(words - base, kFilterRecordWords));
  order_.clear();
}

void FilterBlocks::arrange(std::vector<std::uint32_t>& points) const {
  if (!stores()) return;
  std::ranges::sort(points, {}, [this](std::uint32_t i) { return point_places_[i]; });
}

void FilterBlocks::append(const Block& block, std::vector<Word>& words) {
  append_points(block.points, words);
  append_records(block.candidates, words);
}

void FilterBlocks::append_points(std::span<const std::uint32_t> points, std::vector<Word>& words) {
  const Word header = command_header(kFilterPoints, static_cast<Word>(points.size()));
  std::vector<std::uint32_t> kept;
  std::vector<Word> carried;
  for (const std::uint32_t i : points) {
    const std::uint32_t place = point_places_[i];
    if (points_.has_place(place)) {
      kept.push_back(place);
    } else {
      const auto own = points_.words_of(place);
      carried.insert(carried.end(), own.begin(), own.end());
    }
  }
  if (!stores()) {
    words.push_back(header);
    words.insert(words.end(), carried.begin(), carried.end());
    return;
  }
  std::vector<Word> pieces;
  points_.append(kept, words, pieces);
  if (!carried.empty()) {
    append_store(words, *scratch_, carried);
    append_pieces(pieces, *scratch_, carried.size());
  }
  append_recall(words, header, pieces);
}

void FilterBlocks::append_records(std::span<const std::uint32_t> candidates,
                                  std::vector<Word>& words) {
  std::vector<std::uint32_t> kept;
  std::vector<Word> carried;
  for (const std::uint32_t i : candidates) {
    const std::uint32_t place = record_places_[i];
    if (place == kNowhere) continue;
    if (records_.has_place(place)) {
      kept.push_back(place);
    } else {
      const auto own = records_.words_of(place);
      carried.insert(carried.end(), own.begin(), own.end());
    }
  }
  const auto header = [](std::size_t records) {
    return command_header(kFilterRecords, static_cast<Word>(records));
  };
  if (!kept.empty()) {
    std::vector<Word> pieces;
    records_.append(kept, words, pieces);
    append_recall(words, header(kept.size()), pieces);
  }
  if (!carried.empty()) {
    words.push_back(header(carried.size() / kFilterRecordWords));
    words.insert(words.end(), carried.begin(), carried.end());
  }
}

}  // namespace emax
