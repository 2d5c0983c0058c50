#include "host/files/tolerance.h"

#include <fmt/format.h>

#include <cmath>

#include "host/files/input_file.h"
#include "host/files/number_text.h"
#include "sw_model/base/error.h"

namespace emax {

Tolerance Tolerance::in_unit_of(const std::optional<Unit>& file, std::string_view option) const {
  if (!unit) return *this;
  if (!file) {
    throw Error(fmt::format("{} {}{}: the file does not say its unit; say it with --unit", option,
                            value, unit->name));
  }
  if (unit == file) return {value};
  return {value * unit->metres / file->metres};
}

Tolerance parse_tolerance(std::string_view text, std::string_view option) {
  const auto fail = [&](std::string_view what) {
    throw Error(
        fmt::format("{} {}: {}; give a number above 0 in the file's units (0.5), in a unit (0.5mm) "
                    "or in percent of the width (0.3%)",
                    option, printable(text), what));
  };
  Tolerance tolerance{0};
  std::string_view digits = text;
  for (const Unit& unit : kUnits) {  // "m" is the end of "mm", so the longest counts
    const bool longer = !tolerance.unit || unit.name.size() > tolerance.unit->name.size();
    if (text.ends_with(unit.name) && longer) tolerance.unit = unit;
  }
  if (tolerance.unit) digits.remove_suffix(tolerance.unit->name.size());
  tolerance.percent = text.ends_with('%');
  if (tolerance.percent) digits.remove_suffix(1);
  const std::optional<double> value = parse_double(digits);
  if (!value || std::isnan(*value)) fail("is not a number");
  if (std::isinf(*value)) fail("is infinite");
  if (*value <= 0) fail("is not above 0");
  tolerance.value = *value;
  return tolerance;
}

std::string length_text(double length, const std::optional<Unit>& unit) {
  return fmt::format("{:.6g}{}{}", length, unit ? " " : "", unit ? unit->name : "");
}

std::string to_text(const Tolerance& tolerance, double width, const std::optional<Unit>& unit) {
  return fmt::format("{} ({:.6g}% of the width {})", length_text(tolerance.in_units(width), unit),
                     tolerance.in_percent(width), length_text(width, unit));
}

Tolerance tolerance_of_level(int level) {
  const std::optional<Unit> millimetre = unit_named("mm");
  switch (level) {
    case 20:
      return {50, false, millimetre};
    case 30:
      return {15, false, millimetre};
    case 40:
      return {5, false, millimetre};
    case 50:
      return {1, false, millimetre};
    default:
      throw Error(
          fmt::format("--loa {}: the levels with an upper end of their own are 20, 30, 40 and 50; "
                      "give --max-error for another",
                      level));
  }
}

}  // namespace emax
