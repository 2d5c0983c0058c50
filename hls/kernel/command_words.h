// The command layer: the contents of the two streams of 32-bit words of a device.
//
//   command        header            payload                answer
//   kIdentify      opcode, 0         -                      header, kAnswerIdentity words
//   kLoadPoints    opcode, n         n x (x, y, z)          -
//   kRecords       opcode, m         m x record (20 words)  -
//   kReduce        opcode, options   -                      header[, d^2 of each point], greatest
//                                                           d^2, its index in the block
//   kCounters      opcode, 0         -                      header, kAnswerCounters words or none
//
// A filtering core (filter_words.h) takes these in place of the three that make a block:
//
//   kFilterPoints  opcode, n         n x point (2 words)    -
//   kFilterRecords opcode, m         m x record (11 words)  -
//   kFilterReduce  opcode, options   -                      header[, result of each point],
//   greatest
//                                                           result, its index in the block
//
// A board has both cores and a store, in which data stay. It takes the commands of both, Identify
// and Counters of the filtering core with kOfFilter and Identify of the store with kOfStore, and
//
//   kStore         opcode, n         address, n - 1 words   -
//   kRecall        opcode, n         header, n - 1 pieces   that of the command that it makes
//   kEcho          opcode, n         n words                header, the same words
//
// kStore writes words of the store. kRecall makes a command: its header, then the words that the
// pieces name.
//
// A header is the opcode in the upper 8 bits and a count or options in the lower 24. Loading points
// begins a block: every point's running minimum becomes infinity. Each record then meets every
// point of the block; kReduce sends the answer and ends the block. An answer's header repeats the
// opcode and counts the words after it. After a malformed command the next kReduce answers kError
// with the reason in place of a result. docs/protocol.md is the full definition.
#pragma once

#include "hls/kernel/triangle_record.h"
#include "hls/kernel/word.h"

namespace emax {

constexpr Word kKernelVersion = 1;  // raised whenever the kernel's bits change
constexpr Word kFilterVersion = 1;  // raised whenever the filter's bits change

enum Opcode : Word {
  kIdentify = 1,
  kLoadPoints = 2,
  kRecords = 3,
  kReduce = 4,
  kCounters = 5,
  kFilterPoints = 6,
  kFilterRecords = 7,
  kFilterReduce = 8,
  kStore = 9,
  kRecall = 10,
  kEcho = 11,
  kError = 0xff
};

enum DeviceError : Word {
  kNoError = 0,
  kUnknownCommand = 1,
  kTooManyPoints = 2,
  kNoPoints = 3,
};

// Options of kIdentify and kCounters, to a board.
constexpr Word kOfExact = 0, kOfFilter = 1, kOfStore = 2;
constexpr Word kReduceListsPoints = 1;  // option of kReduce: also the d^2 of every point

constexpr Word kMaxBlockPoints = 1024;
constexpr Word kPointWords = 3;
// Kernel version, kMaxBlockPoints, words of a record, elements, clock in kHz (0: not known).
constexpr Word kAnswerIdentity = 5;
constexpr Word kAnswerCounters = 6;  // cycles busy, stalled, idle: each its low and its high word
constexpr Word kAnswerWorst = 2;     // squared distance, index

// Version of the store's commands, its words.
constexpr Word kStoreVersion = 1;
constexpr Word kAnswerStore = 2;
// A piece of the store: the address of its first word in the lower bits, above it the number of
// words after the first.
constexpr Word kPieceAddressBits = 22;
constexpr Word kMaxPieceWords = 1u << (32 - kPieceAddressBits);
constexpr Word kMaxStoreWords = 1u << kPieceAddressBits;

constexpr Word kCountBits = 24;
constexpr Word kMaxCount = (1u << kCountBits) - 1;

static_assert(kMaxBlockPoints + kAnswerWorst <= kMaxCount, "an answer's count fits its header");

inline Word command_header(Opcode opcode, Word count) { return (opcode << kCountBits) | count; }
inline Word header_opcode(Word header) { return header >> kCountBits; }
inline Word header_count(Word header) { return header & kMaxCount; }

inline Word store_piece(Word address, Word words) {
  return address | (words - 1) << kPieceAddressBits;
}
inline Word piece_address(Word piece) { return piece & (kMaxStoreWords - 1); }
inline Word piece_words(Word piece) { return (piece >> kPieceAddressBits) + 1; }

}  // namespace emax
