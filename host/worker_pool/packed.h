#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "sw_model/base/error.h"

namespace emax {

// Values as a byte string of CBOR, as they lie in memory. O(n).
template <typename T>
nlohmann::json packed(const std::vector<T>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) {
    std::memcpy(bytes.data(), static_cast<const void*>(values.data()), bytes.size());
  }
  return nlohmann::json::binary(std::move(bytes));
}

// Throws Error if the string ends within a value, and json::exception if it is none.
template <typename T>
std::vector<T> unpacked(const nlohmann::json& value) {
  const std::vector<std::uint8_t>& bytes = value.get_binary();
  if (bytes.size() % sizeof(T) != 0) throw Error("a byte string is cut short");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

}  // namespace emax
