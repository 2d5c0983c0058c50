#pragma once

#include <bit>
#include <string>

namespace emax {

// The bytes of the value, the least significant first.
template <class Value>
void append_value(std::string& bytes, const Value& value) {
  static_assert(std::endian::native == std::endian::little);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace emax
