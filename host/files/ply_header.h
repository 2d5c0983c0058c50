#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/files/input_file.h"

namespace emax {

// The text at the begin of a PLY file, which names elements and their properties.

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

inline std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> list_count;  // set for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool text = false;
  bool big_endian = false;
  std::vector<PlyElement> elements;
  std::uint64_t body = 0;     // offset of the first byte of values
  std::size_t last_line = 0;  // of the header
};

// Throws Error where it is not such a text.
PlyHeader read_ply_header(const InputStream& input);

}  // namespace emax
