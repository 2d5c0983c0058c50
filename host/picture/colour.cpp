#include "host/picture/colour.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace emax {
namespace {

constexpr std::array<Colour, 9> kViridis = {{{68, 1, 84},
                                             {71, 44, 122},
                                             {59, 81, 139},
                                             {44, 113, 142},
                                             {33, 144, 141},
                                             {39, 173, 129},
                                             {92, 200, 99},
                                             {170, 220, 50},
                                             {253, 231, 37}}};
constexpr std::array<Colour, 9> kBlueToRed = {{{31, 78, 156},
                                               {63, 127, 193},
                                               {127, 178, 217},
                                               {188, 213, 228},
                                               {222, 220, 214},
                                               {236, 195, 169},
                                               {223, 143, 110},
                                               {196, 82, 74},
                                               {150, 28, 44}}};
constexpr Colour kAbove = {255, 176, 0}, kBelow = {180, 75, 224}, kFar = {240, 80, 45};

// Between equally spaced colours.
Colour between(std::span<const Colour> map, double position) {
  const double at = std::clamp(position, 0.0, 1.0) * static_cast<double>(map.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), map.size() - 2);
  const double part = at - static_cast<double>(i);
  Colour colour;
  for (std::size_t k = 0; k < colour.size(); ++k) {
    colour[k] =
        static_cast<std::uint8_t>(std::lround((1 - part) * map[i][k] + part * map[i + 1][k]));
  }
  return colour;
}

}  // namespace

Colour viridis(double position) { return between(kViridis, position); }

Colour deviation_colour(double deviation, double reach, bool is_signed) {
  const double share = deviation / reach;
  if (!is_signed) return share > 1 ? kFar : viridis(share);
  if (share > 1) return kAbove;
  return share < -1 ? kBelow : between(kBlueToRed, (share + 1) / 2);
}

}  // namespace emax
