#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "host/picture/colour.h"

namespace emax {

// The bytes of a PNG file with 8 bits for each colour. `pixels`: row after row from the top.
std::string png_bytes(std::span<const Colour> pixels, std::uint32_t width, std::uint32_t height);

}  // namespace emax
