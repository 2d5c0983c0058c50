#include "host/files/tolerance.h"

#include <fmt/format.h>

#include <cmath>

#include "host/files/input_file.h"
#include "host/files/number_text.h"
#include "sw_model/base/error.h"

namespace emax {

Tolerance parse_tolerance(std::string_view text, std::string_view option) {
  const auto fail = [&](std::string_view what) {
    throw Error(
        fmt::format("{} {}: {}; give a number above 0 in the file's units (0.5) or in percent of "
                    "the width (0.3%)",
                    option, printable(text), what));
  };
  const bool percent = text.ends_with('%');
  const std::string_view digits = text.substr(0, text.size() - (percent ? 1 : 0));
  const std::optional<double> value = parse_double(digits);
  if (!value || std::isnan(*value)) fail("is not a number");
  if (std::isinf(*value)) fail("is infinite");
  if (*value <= 0) fail("is not above 0");
  return {*value, percent};
}

std::string to_text(const Tolerance& tolerance, double width) {
  return fmt::format("{:.6g} ({:.6g}% of the width {:.6g})", tolerance.in_units(width),
                     tolerance.in_percent(width), width);
}

}  // namespace emax
