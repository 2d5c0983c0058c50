#pragma once

#include <cstdint>
#include <span>

namespace emax {

// CRC-32 as in Ethernet and zlib.
std::uint32_t crc32(std::span<const std::uint8_t> bytes);

}  // namespace emax
