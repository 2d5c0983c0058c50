// The top of the kernel: command words in, answer words out. The same function is the C simulation
// of HLS compilers (binary32), the `sim` device (flushing scalar) and the definition of the command
// layer that the hardware is proven against.
#pragma once

#include "hls/kernel/command_words.h"
#include "hls/kernel/hls_target.h"
#include "hls/kernel/point_triangle.h"
#include "hls/kernel/reduce.h"

namespace emax {

template <class Scalar>
class EmaxKernel {
 public:
  // Serves one command. In hardware it waits for the streams; in software all words of the command
  // must be in the stream before the call.
  void serve(Stream<Word>& commands, Stream<Word>& answers) {
    const Word header = commands.read();
    const Word count = header_count(header);
    switch (header_opcode(header)) {
      case kIdentify:
        answers.write(command_header(kIdentify, kAnswerIdentity));
        answers.write(kKernelVersion);
        answers.write(kMaxBlockPoints);
        answers.write(kRecordWords);
        answers.write(1);  // element
        answers.write(0);  // no clock
        break;
      case kLoadPoints:
        load_points(count, commands);
        break;
      case kRecords:
        for (Word i = 0; i < count; ++i) {
          meet_record(commands);
        }
        break;
      case kReduce:
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
  static Scalar read_scalar(Stream<Word>& commands) { return Scalar(to_float(commands.read())); }

  static Vector3<Scalar> read_vector(Stream<Word>& commands) {
    const Scalar x = read_scalar(commands);
    const Scalar y = read_scalar(commands);
    const Scalar z = read_scalar(commands);
    return {x, y, z};
  }

  struct ReadScalar {
    Stream<Word>& commands;
    void operator()(Scalar& scalar) const { scalar = read_scalar(commands); }
  };

  static TriangleRecord<Scalar> read_record(Stream<Word>& commands) {
    TriangleRecord<Scalar> record;
    const ReadScalar read = {commands};
    for_each_scalar(read, record);
    record.tag = commands.read();
    return record;
  }

  void load_points(Word count, Stream<Word>& commands) {
    const bool fits = count <= kMaxBlockPoints;
    error_ = fits ? error_ : Word(kTooManyPoints);
    count_ = fits ? count : 0;
    for (Word i = 0; i < count; ++i) {
      EMAX_HLS(PIPELINE II = 3)
      const Vector3<Scalar> point = read_vector(commands);
      if (fits) {
        points_[i] = point;
        nearest_[i] = kInfinityWord;
      }
    }
  }

  // One pair a cycle: the running minimum of a point is read and written once per record.
  void meet_record(Stream<Word>& commands) {
    const TriangleRecord<Scalar> record = read_record(commands);
    const bool segment = (record.tag & kSegmentFlag) != 0;
    for (Word i = 0; i < count_; ++i) {
      EMAX_HLS(PIPELINE II = 1)
      EMAX_HLS(DEPENDENCE variable = nearest_ inter false)
      nearest_[i] = minimum(nearest_[i], to_word(squared_distance(record, segment, points_[i])));
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
    answers.write(command_header(kReduce, kAnswerWorst + (list_points ? count_ : 0)));
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

  Vector3<Scalar> points_[kMaxBlockPoints];
  Word nearest_[kMaxBlockPoints];
  Word count_ = 0;
  Word error_ = kNoError;
};

}  // namespace emax
