#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "host/geometry/unit.h"

namespace emax {

// What a coordinate reference system of a LAS file says of its lengths. A unit that is not one of
// ours is nothing.
struct LasLengths {
  std::optional<Unit> unit;
  std::optional<Unit> heights;  // where it is said apart
  bool angles = false;          // longitudes and latitudes in place of lengths
};

// Of the record of GeoTIFF keys (OGC 19-008r4, annex B).
LasLengths lengths_of_keys(std::span<const std::uint8_t> keys);

// Of well-known text (OGC 01-009 and 18-010r7), of which only the units are looked at: PROJ, which
// reads it whole, would bring its database and a client of networks into every package. Text that
// is no well-known text says nothing. O(text).
LasLengths lengths_of_text(std::string_view text);

}  // namespace emax
