#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "host/geometry/unit.h"

namespace emax {

// The names that a 3MF model gives to the units of kUnits. A model that names none is in mm.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kThreeMfUnits = {
    {{"micron", "um"},
     {"millimeter", "mm"},
     {"centimeter", "cm"},
     {"inch", "in"},
     {"foot", "ft"},
     {"meter", "m"}}};

// The name of the unit in a model; nothing for the US survey foot.
inline std::optional<std::string_view> threemf_unit(const Unit& unit) {
  for (const auto& [theirs, ours] : kThreeMfUnits) {
    if (ours == unit.name) return theirs;
  }
  return std::nullopt;
}

// The part with the mesh in an archive that emax writes.
inline constexpr std::string_view kThreeMfModelPart = "3D/3dmodel.model";

inline constexpr std::string_view kThreeMfCore =
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
inline constexpr std::string_view kThreeMfModelType =
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
inline constexpr std::string_view kRelationships =
    "http://schemas.openxmlformats.org/package/2006/relationships";

}  // namespace emax
