// The top of the kernel, and of the fixed-point filter: command words in, answer words out. The
// same function is the C simulation of HLS compilers (binary32), the `sim` device (flushing scalar)
// and the definition of the command layer that the hardware is proven against.
#pragma once

#include "hls/kernel/command_words.h"
#include "hls/kernel/filter_words.h"
#include "hls/kernel/hls_target.h"
#include "hls/kernel/point_triangle.h"
#include "hls/kernel/reduce.h"

namespace emax {

// What a block's pairs are, and the commands that make it: the kernel's own.
template <class Scalar>
struct ExactPair {
  using Point = Vector3<Scalar>;
  using Record = TriangleRecord<Scalar>;

  static constexpr Word kLoad = kLoadPoints, kMeet = kRecords, kAnswer = kReduce;
  static constexpr Word kVersion = kKernelVersion, kWords = kRecordWords;
  static constexpr Word kUnmet = kInfinityWord;

  static Point read_point(Stream<Word>& commands) {
    const Scalar x = read_scalar(commands);
    const Scalar y = read_scalar(commands);
    const Scalar z = read_scalar(commands);
    return {x, y, z};
  }
  static Record read_record(Stream<Word>& commands) {
    Record record;
    const ReadScalar read = {commands};
    for_each_scalar(read, record);
    record.tag = commands.read();
    return record;
  }
  static Word result(const Record& record, bool segment, const Point& point) {
    return to_word(squared_distance(record, segment, point));
  }

 private:
  static Scalar read_scalar(Stream<Word>& commands) { return Scalar(to_float(commands.read())); }
  struct ReadScalar {
    Stream<Word>& commands;
    void operator()(Scalar& scalar) const { scalar = read_scalar(commands); }
  };
};

// The filtering core's (filter_words.h).
struct FilterPair {
  using Point = Vector3<FilterNumber>;
  using Record = TriangleRecord<FilterNumber>;

  static constexpr Word kLoad = kFilterPoints, kMeet = kFilterRecords, kAnswer = kFilterReduce;
  static constexpr Word kVersion = kFilterVersion, kWords = kFilterRecordWords;
  static constexpr Word kUnmet = kFilterFar;

  static Point read_point(Stream<Word>& commands) {
    Word words[kFilterPointWords];
    for (Word& word : words) word = commands.read();
    return unpacked_filter_point(words);
  }
  static Record read_record(Stream<Word>& commands) {
    Word words[kFilterRecordWords];
    for (Word& word : words) word = commands.read();
    return unpacked_filter_record(words);
  }
  static Word result(const Record& record, bool segment, const Point& point) {
    return filter_word(squared_distance_below_one(record, segment, point));
  }
};

template <class Pair>
class BlockKernel {
 public:
  // Serves one command. In hardware it waits for the streams; in software all words of the command
  // must be in the stream before the call.
  void serve(Stream<Word>& commands, Stream<Word>& answers) {
    const Word header = commands.read();
    const Word count = header_count(header);
    switch (header_opcode(header)) {
      case kIdentify:
        answers.write(command_header(kIdentify, kAnswerIdentity));
        answers.write(Word(Pair::kVersion));
        answers.write(kMaxBlockPoints);
        answers.write(Word(Pair::kWords));
        answers.write(1);  // element
        answers.write(0);  // no clock
        break;
      case Pair::kLoad:
        load_points(count, commands);
        break;
      case Pair::kMeet:
        for (Word i = 0; i < count; ++i) {
          meet_record(commands);
        }
        break;
      case Pair::kAnswer:
        reduce((count & kReduceListsPoints) != 0, answers);
        break;
      case kCounters:
        answers.write(command_header(kCounters, 0));
        break;
      default:
        error_ = kUnknownCommand;
        break;
    }
  }

 private:
  void load_points(Word count, Stream<Word>& commands) {
    const bool fits = count <= kMaxBlockPoints;
    error_ = fits ? error_ : Word(kTooManyPoints);
    count_ = fits ? count : 0;
    for (Word i = 0; i < count; ++i) {
      EMAX_HLS(PIPELINE II = 3)
      const typename Pair::Point point = Pair::read_point(commands);
      if (fits) {
        points_[i] = point;
        nearest_[i] = Pair::kUnmet;
      }
    }
  }

  // One pair a cycle: the running minimum of a point is read and written once per record.
  void meet_record(Stream<Word>& commands) {
    const typename Pair::Record record = Pair::read_record(commands);
    const bool segment = (record.tag & kSegmentFlag) != 0;
    for (Word i = 0; i < count_; ++i) {
      EMAX_HLS(PIPELINE II = 1)
      EMAX_HLS(DEPENDENCE variable = nearest_ inter false)
      nearest_[i] = minimum(nearest_[i], Pair::result(record, segment, points_[i]));
    }
  }

  void reduce(bool list_points, Stream<Word>& answers) {
    if (error_ == kNoError && count_ == 0) {
      error_ = kNoPoints;
    }
    if (error_ != kNoError) {
      answers.write(command_header(kError, 1));
      answers.write(error_);
      error_ = kNoError;
      count_ = 0;
      return;
    }
    answers.write(command_header(Opcode(Pair::kAnswer), kAnswerWorst + (list_points ? count_ : 0)));
    WorstPoint<Word> worst = {nearest_[0], 0};
    for (Word i = 0; i < count_; ++i) {
      EMAX_HLS(PIPELINE II = 1)
      worst = maximum(worst, WorstPoint<Word>{nearest_[i], i});
      if (list_points) {
        answers.write(nearest_[i]);
      }
    }
    answers.write(worst.squared_distance);
    answers.write(worst.index);
    count_ = 0;
  }

  typename Pair::Point points_[kMaxBlockPoints];
  Word nearest_[kMaxBlockPoints];
  Word count_ = 0;
  Word error_ = kNoError;
};

template <class Scalar>
using EmaxKernel = BlockKernel<ExactPair<Scalar>>;
using FilterKernel = BlockKernel<FilterPair>;

}  // namespace emax
