// The words of the fixed-point filter's points, records and results (hls/kernel/command_words.h).
//
//   point    2 words    x, y, z from bit 0 on, 18 bits each
//   record   11 words   the 19 numbers of a TriangleRecord in the order of its words from bit 0 on,
//                       18 bits each, then a bit for kSegmentFlag
//   result   1 word     the squared distance in steps of 2^-32; kFilterFar for 1 and more
//
// Bit 0 is the lowest of the first word. What lies above the last number has no meaning.
#ifndef EMAX_HLS_KERNEL_FILTER_WORDS_H
#define EMAX_HLS_KERNEL_FILTER_WORDS_H

#include "hls/kernel/fixed.h"
#include "hls/kernel/forms/guarded_edge.h"
#include "hls/kernel/triangle_record.h"
#include "hls/kernel/word.h"

namespace emax {

using FilterNumber = Fixed<18, 16, Rounding::kHalfUp, Overflow::kSaturate>;

constexpr std::uint32_t kFilterNumberBits = 18;
constexpr std::uint32_t kFilterPointWords = 2;
constexpr std::uint32_t kFilterRecordWords = 11;
constexpr std::uint32_t kFilterSegmentBit = (kRecordWords - 1) * kFilterNumberBits;
// Of a pair that is 1 or more apart, and of a point that has met no triangle.
constexpr Word kFilterFar = 0xffffffffu;

static_assert(FilterNumber::format().width == kFilterNumberBits, "the words hold whole numbers");
static_assert(3 * kFilterNumberBits <= 32 * kFilterPointWords, "a point fits its words");
static_assert(kFilterSegmentBit < 32 * kFilterRecordWords, "a record fits its words");
static_assert(SquareBelowOne<FilterNumber>::format().width == 33,
              "a result is a word, not negative");

// `bits`, at most 31, of words that begin at bit `at`.
inline Word packed_bits(const Word* words, std::uint32_t at, std::uint32_t bits) {
  const std::uint32_t place = at % 32;
  const Word low = words[at / 32] >> place;
  const Word high = place + bits > 32 ? words[at / 32 + 1] << (32 - place) : 0;
  return (low | high) & ((Word(1) << bits) - 1);
}

// Writes a number of `bits`, at most 31, at bit `at` of words that are zero there.
inline void pack_bits(Word* words, std::uint32_t at, std::uint32_t bits, Word value) {
  const std::uint32_t place = at % 32;
  const Word kept = value & ((Word(1) << bits) - 1);
  words[at / 32] |= kept << place;
  if (place + bits > 32) words[at / 32 + 1] |= kept >> (32 - place);
}

// Numbers one behind the other, for for_each_scalar().
struct UnpackFilterNumbers {
  const Word* words;
  std::uint32_t* at;
  void operator()(FilterNumber& number) const {
    number = FilterNumber::from_raw(packed_bits(words, *at, kFilterNumberBits));
    *at += kFilterNumberBits;
  }
};
struct PackFilterNumbers {
  Word* words;
  std::uint32_t* at;
  void operator()(const FilterNumber& number) const {
    pack_bits(words, *at, kFilterNumberBits, static_cast<Word>(number.raw()));
    *at += kFilterNumberBits;
  }
};

inline Vector3<FilterNumber> unpacked_filter_point(const Word* words) {
  std::uint32_t at = 0;
  const UnpackFilterNumbers next = {words, &at};
  Vector3<FilterNumber> point;
  next(point.x);
  next(point.y);
  next(point.z);
  return point;
}

// The tag holds kSegmentFlag or nothing.
inline TriangleRecord<FilterNumber> unpacked_filter_record(const Word* words) {
  std::uint32_t at = 0;
  TriangleRecord<FilterNumber> record;
  const UnpackFilterNumbers next = {words, &at};
  for_each_scalar(next, record);
  record.tag = packed_bits(words, kFilterSegmentBit, 1) != 0 ? kSegmentFlag : 0;
  return record;
}

// Words that are zero.
inline void pack_filter_point(const Vector3<FilterNumber>& point, Word* words) {
  std::uint32_t at = 0;
  const PackFilterNumbers next = {words, &at};
  next(point.x);
  next(point.y);
  next(point.z);
}
inline void pack_filter_record(const TriangleRecord<FilterNumber>& record, Word* words) {
  std::uint32_t at = 0;
  const PackFilterNumbers next = {words, &at};
  for_each_scalar(next, record);
  pack_bits(words, kFilterSegmentBit, 1, (record.tag & kSegmentFlag) != 0 ? 1 : 0);
}

// The result of a pair.
inline Word filter_word(const SquareBelowOne<FilterNumber>& squared) {
  return static_cast<Word>(squared.raw());
}

}  // namespace emax

#endif
