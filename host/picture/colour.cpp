#include "host/picture/colour.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace emax {
namespace {

constexpr std::array<Colour, 9> kViridis = {{{68, 1, 84},
                                             {71, 45, 123},
                                             {59, 82, 139},
                                             {44, 114, 142},
                                             {33, 145, 140},
                                             {40, 174, 128},
                                             {94, 201, 98},
                                             {173, 220, 48},
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
constexpr DeviationScale kWithSign = {kBlueToRed, kAbove, kBelow};
constexpr DeviationScale kWithoutSign = {kViridis, kFar, kFar};

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

const DeviationScale& deviation_scale(bool is_signed) {
  return is_signed ? kWithSign : kWithoutSign;
}

Colour viridis(double position) { return between(kViridis, position); }

Colour deviation_colour(double deviation, double reach, bool is_signed) {
  const DeviationScale& scale = deviation_scale(is_signed);
  const double share = deviation / reach;
  if (share > 1) return scale.above;
  if (share < -1) return scale.below;
  return between(scale.stops, is_signed ? (share + 1) / 2 : share);
}

Colour distinct_colour(std::size_t n) {
  constexpr double kGolden = 0.6180339887498949;  // of a turn
  constexpr std::array<double, 3> kBrightness = {0.95, 0.75, 0.55};
  const double turns = kGolden * static_cast<double>(n), hue = 6 * (turns - std::floor(turns));
  constexpr double kSaturation = 0.65;
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    const double apart = std::abs(std::fmod(hue + 6 - 2 * static_cast<double>(c), 6) - 3);
    const double share = std::clamp(apart - 1, 0.0, 1.0);
    const double value = kBrightness[n % 3] * (1 - kSaturation * (1 - share));
    colour[c] = static_cast<std::uint8_t>(std::lround(255 * value));
  }
  return colour;
}

}  // namespace emax
