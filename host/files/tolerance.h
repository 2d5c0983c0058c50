#pragma once

#include <string>
#include <string_view>

namespace emax {

// A bound on the maximum error, as given to --max-error: in file units, or in percent of the width
// of the cloud (the longest side of its axis-aligned bounding box).
struct Tolerance {
  double value;
  bool percent;

  double in_units(double width) const { return percent ? value * width / 100 : value; }
  double in_percent(double width) const { return percent ? value : 100 * value / width; }
};

// "N" or "N%", nothing else, N > 0 and finite. Throws Error naming the option.
Tolerance parse_tolerance(std::string_view text, std::string_view option = "--max-error");

// In both units, with six digits: "0.5 (0.321% of the width 155.7)".
std::string to_text(const Tolerance& tolerance, double width);

}  // namespace emax
