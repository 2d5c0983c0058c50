#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace emax {

// A unit of length that files and tolerances are given in.
struct Unit {
  std::string_view name;  // as in --unit, "mm"
  double metres;
  bool operator==(const Unit&) const = default;
};

// The US survey foot is 1200/3937 m, the inch 25.4 mm (NIST SP 811, appendix B).
inline constexpr std::array<Unit, 7> kUnits = {{{"mm", 1e-3},
                                                {"cm", 1e-2},
                                                {"m", 1},
                                                {"in", 0.0254},
                                                {"ft", 0.3048},
                                                {"us-ft", 1200.0 / 3937},
                                                {"um", 1e-6}}};

// Nothing for another name.
std::optional<Unit> unit_named(std::string_view name);

}  // namespace emax
