#include "host/decimate/race.h"

#include <array>

#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

// Of the triangles at a point, what the passes behind it leave.
struct Shares {
  double least, usual;
};
constexpr std::array<Shares, 4> kLeft = {{{0.5, 0.68}, {0.88, 1}, {0.8, 0.95}, {0.7, 0.85}}};

}  // namespace

bool Race::lost(At at, std::size_t triangles) {
  if (lost() || rival_ == 0) return lost();
  const auto [least, usual] = kLeft[static_cast<std::size_t>(at)];
  const auto present = static_cast<double>(triangles);
  const double hope = EMAX_FAULT(kGivesUpEarly) ? 1.5 * least : least;
  if (hope * present > static_cast<double>(rival_)) {
    expected_ = static_cast<std::size_t>(usual * present);
  }
  return lost();
}

}  // namespace emax
