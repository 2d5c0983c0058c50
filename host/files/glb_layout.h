#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "host/geometry/unit.h"

namespace emax {

// Numbers of glTF 2.0 (Khronos, ISO/IEC 12113) that its writer and its reader share.
inline constexpr std::string_view kGlbMagic = "glTF";
inline constexpr std::uint32_t kGlbVersion = 2;
inline constexpr std::uint32_t kGlbJson = 0x4e4f534a;    // "JSON"
inline constexpr std::uint32_t kGlbBinary = 0x004e4942;  // "BIN\0"
inline constexpr int kGltfFloat = 5126, kGltfUint8 = 5121, kGltfInt8 = 5120, kGltfUint16 = 5123,
                     kGltfInt16 = 5122, kGltfUint32 = 5125;

inline constexpr std::string_view kGlbGenerator = "emax";
// The key in the extras of the frame, a node above the mesh: the unit of the coordinates below it.
inline constexpr const char* kGlbUnitKey = "unit";

// glTF is in metres with y up. The frame turns and scales coordinates with z up, in `unit`, to
// that. Sixteen numbers, column by column. Without a unit, lengths are taken as metres.
inline std::array<double, 16> glb_frame(const std::optional<Unit>& unit) {
  const double s = unit ? unit->metres : 1;
  return {s, 0, 0, 0, 0, 0, -s, 0, 0, s, 0, 0, 0, 0, 0, 1};
}

}  // namespace emax
