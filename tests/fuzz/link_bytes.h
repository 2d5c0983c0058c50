#pragma once

#include <optional>

#include "sw_model/protocol/frames.h"
#include "tests/fuzz/target.h"

namespace emax::fuzz {

// An input as a row of items that arrive on the link. A fuzzer does not find a CRC, so an item may
// be a whole frame. Each item begins with a byte whose remainder by 4 tells its kind:
//   0  raw bytes: their count in a byte, the bytes
//   1  a frame of the session at hand: its kind, sequence, expected, credit and words in a byte
//      each, then the bytes of the words
//   2  a frame of any session and version: the same after two bytes of session and one of version
//   3  nothing: a silence
// What is missing at the end of the input counts as zero.
class LinkItems {
 public:
  explicit LinkItems(Input input) : left_(input) {}

  // The bytes of the next item; nothing at the end of the input.
  std::optional<std::vector<std::uint8_t>> next(std::uint16_t session);

 private:
  std::uint8_t byte();
  std::uint16_t two_bytes();

  Input left_;
};

// The items that LinkItems makes these frames of.
std::string frame_item(const Frame& frame);

}  // namespace emax::fuzz
