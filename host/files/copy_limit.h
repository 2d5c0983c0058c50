#pragma once

#include <cstdint>

#include "host/files/input_file.h"

namespace emax {

// A small file can place one part very often, or place parts of parts. This counts the vertices and
// triangles that a reader makes, and refuses more than the file can hold once and kCopies.
class CopyLimit {
 public:
  explicit CopyLimit(const InputFile& input) : input_(input) {}

  // The file holds `count` more vertices and triangles, or has that many bytes for them.
  void allow(std::uint64_t count) { left_ += count; }

  // Throws Error when `count` more are too many.
  void spend(std::uint64_t count) {
    if (count > left_) {
      input_.fail("the copies of its parts hold too many vertices and triangles",
                  "export one copy of each part");
    }
    left_ -= count;
  }

 private:
  static constexpr std::uint64_t kCopies = 4'000'000;

  const InputFile& input_;
  std::uint64_t left_ = kCopies;
};

}  // namespace emax
