#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace emax {

// The numbers that $INSUNITS of a DXF file gives to the units of kUnits; 0 is no unit.
inline constexpr std::array<std::pair<int, std::string_view>, 7> kDxfUnits = {
    {{1, "in"}, {2, "ft"}, {4, "mm"}, {5, "cm"}, {6, "m"}, {13, "um"}, {21, "us-ft"}}};

}  // namespace emax
