#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace emax::test {

// Appends a value's bytes, as a little- or big-endian machine would write them.
template <class Value>
void append(std::string& bytes, Value value, bool big_endian = false) {
  auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  if (big_endian) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

}  // namespace emax::test
