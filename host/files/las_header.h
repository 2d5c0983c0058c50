#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/files/input_file.h"
#include "host/files/las_reference_system.h"
#include "host/geometry/unit.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// The bytes of a LAS file, of which those are asked for that stand behind those before.
struct LasBytes {
  const NamedInput& input;
  std::uint64_t size;  // of all; the greatest number where it is not known
  std::function<void(std::uint64_t offset, std::span<std::uint8_t> to)> read;
};

template <class Number>
Number load_little_endian(const std::uint8_t* bytes) {
  static_assert(std::endian::native == std::endian::little);
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

inline constexpr int kFirstExtendedFormat = 6;

struct LasHeader {
  int minor = 0;
  std::uint16_t header_bytes = 0;
  std::uint32_t offset = 0, records = 0;  // of the points; of variable length
  int format = 0;
  bool compressed = false;
  std::uint16_t point_bytes = 0;
  std::uint64_t points = 0;
  bool may_follow = false;  // data after the points: waveforms, extended records
  Point scale, shift, greatest, least;
};

// As PointCloud::resolution.
inline double resolution_of_las(const LasHeader& header) { return header.scale.norm() / 2; }

// What the records of variable length say.
struct LasRecords {
  std::optional<LasLengths> keys, text;
  std::optional<std::vector<std::uint8_t>> laz;
};

// Both throw Error where the header or the records are not as they have to be.
LasHeader read_las_header(const LasBytes& bytes);
LasRecords read_las_records(const LasBytes& bytes, const LasHeader& header);

// The unit of the coordinates, where it is stated and one of ours. Throws Error where they are
// angles, or where heights have another unit.
std::optional<Unit> unit_of_las(const NamedInput& input, const LasRecords& records);

}  // namespace emax
