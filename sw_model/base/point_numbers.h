#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace emax {

// The numbers of some points of a cloud: `first`, first + 1, ..., or those listed, which ascend.
struct PointNumbers {
  std::uint32_t first = 0;
  std::span<const std::uint32_t> listed = {};

  std::uint32_t operator[](std::size_t i) const {
    return listed.empty() ? first + static_cast<std::uint32_t>(i) : listed[i];
  }
};

}  // namespace emax
