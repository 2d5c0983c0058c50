#include "host/geometry/unit.h"

#include <algorithm>

namespace emax {

std::optional<Unit> unit_named(std::string_view name) {
  const auto unit = std::ranges::find(kUnits, name, &Unit::name);
  return unit == kUnits.end() ? std::nullopt : std::optional(*unit);
}

}  // namespace emax
