#pragma once

#include <cstdint>
#include <string_view>

#include "host/files/input_file.h"

namespace emax {

// A few bytes can inflate to gigabytes. Files of scans and meshes shrink to a tenth, seldom to a
// fiftieth; what inflates to more than 100 times its size and 64 MiB is refused.
class InflationLimit {
 public:
  InflationLimit(const NamedInput& input, std::uint64_t compressed)
      : input_(input), left_(kAlways + kGreatestRatio * compressed) {}

  // Throws Error when `bytes` more are too many.
  void spend(std::uint64_t bytes) {
    if (bytes > left_) {
      input_.fail("it inflates to more than 100 times its size",
                  "decompress it with another program if that is meant");
    }
    left_ -= bytes;
  }

 private:
  static constexpr std::uint64_t kAlways = std::uint64_t{64} << 20, kGreatestRatio = 100;

  const NamedInput& input_;
  std::uint64_t left_;
};

}  // namespace emax
