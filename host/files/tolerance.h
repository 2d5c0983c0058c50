#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/geometry/unit.h"

namespace emax {

// A bound on the maximum error, as given to --max-error: in file units, in a unit of its own, or in
// percent of the width of the cloud (the longest side of its axis-aligned bounding box).
struct Tolerance {
  double value;
  bool percent = false;
  std::optional<Unit> unit = {};  // nothing: the file's

  // Without a unit of its own, for a file in this unit. Throws Error naming the option where the
  // file's is not known.
  Tolerance in_unit_of(const std::optional<Unit>& file,
                       std::string_view option = "--max-error") const;

  // These need a tolerance without a unit of its own.
  double in_units(double width) const { return percent ? value * width / 100 : value; }
  double in_percent(double width) const { return percent ? value : 100 * value / width; }
};

// "N", "N%" or "Nmm" and the like (kUnits), nothing else, N > 0 and finite. Throws Error naming the
// option.
Tolerance parse_tolerance(std::string_view text, std::string_view option = "--max-error");

// In both ways, with six digits: "0.5 (0.321% of the width 155.7)"; with the file's unit, where it
// is known, "0.5 mm (0.321% of the width 155.7 mm)".
std::string to_text(const Tolerance& tolerance, double width,
                    const std::optional<Unit>& unit = std::nullopt);

// The length with six digits and its unit, where that is known: "0.5 mm".
std::string length_text(double length, const std::optional<Unit>& unit);

// The greatest deviation that a level of accuracy of the USIBD (Level of Accuracy Specification
// Guide) allows: the upper end of its range, 15 mm for 30. The level is 20, 30, 40 or 50; that of
// 10 is left to its user.
Tolerance tolerance_of_level(int level);

}  // namespace emax
