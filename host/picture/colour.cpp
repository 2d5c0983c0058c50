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
constexpr std::array<Colour, 9> kCoolToWarm = {{{59, 76, 192},
                                                {98, 130, 234},
                                                {141, 176, 254},
                                                {184, 208, 249},
                                                {221, 221, 221},
                                                {245, 196, 173},
                                                {244, 154, 123},
                                                {222, 96, 77},
                                                {180, 4, 38}}};

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

Colour cool_to_warm(double position) { return between(kCoolToWarm, (position + 1) / 2); }

}  // namespace emax
