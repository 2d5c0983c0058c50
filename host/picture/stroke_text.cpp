#include "host/picture/stroke_text.h"

#include <optional>
#include <utility>

namespace emax {
namespace {

constexpr double kHeight = 6;     // of digits, on the grid of the strokes
constexpr double kAdvance = 5.6;  // from a character to the next
constexpr double kAdvanceOfPoint = 3;
constexpr double kRadius = 0.4;

// Corners of strokes as pairs of digits: x from 0 to 4, y from the top, 0, to the line, 6. A blank
// lies between corners, a bar between strokes.
constexpr std::pair<char, std::string_view> kStrokes[] = {
    {'0', "10 30 41 45 36 16 05 01 10"},
    {'1', "11 20 26|16 36"},
    {'2', "01 10 30 41 42 06 46"},
    {'3', "01 10 30 41 42 33 44 45 36 16 05|33 23"},
    {'4', "36 30 04 44"},
    {'5', "40 00 02 32 43 45 36 06"},
    {'6', "30 10 01 05 16 36 45 44 33 03"},
    {'7', "00 40 16"},
    {'8', "10 30 41 42 33 13 02 01 10|13 04 05 16 36 45 44 33"},
    {'9', "16 36 45 41 30 10 01 02 13 43"},
    {'.', "06 06"},
    {'-', "13 33"},
    {'+', "03 43|21 25"},
    {'c', "43 32 12 03 05 16 36 45"},
    {'e', "04 44 43 32 12 03 05 16 36 45"},
    {'f', "30 20 11 16|02 32"},
    {'i', "22 26|20 20"},
    {'m', "06 02|03 12 23 26|23 32 43 46"},
    {'n', "06 02|03 12 32 43 46"},
    {'s', "42 12 03 14 34 45 36 06"},
    {'t', "10 15 26 36|02 32"},
    {'u', "02 05 16 36 45|42 46"}};

std::string_view strokes_of(char c) {
  for (const auto& [character, strokes] : kStrokes) {
    if (character == c) return strokes;
  }
  return "";
}

}  // namespace

void draw_text(Raster& raster, std::string_view text, const Eigen::Vector2d& at, double height,
               const Colour& colour) {
  const double scale = height / kHeight;
  double left = 0;
  for (const char c : text) {
    const std::string_view strokes = strokes_of(c);
    std::optional<Eigen::Vector2d> from;
    for (std::size_t k = 0; k + 1 < strokes.size(); k += 3) {
      const Eigen::Vector2d corner(left + strokes[k] - '0', strokes[k + 1] - '0' - kHeight / 2);
      const Eigen::Vector2d to = at + scale * corner;
      if (from) raster.line(*from, to, kRadius * scale, colour);
      const bool ends = k + 2 < strokes.size() && strokes[k + 2] == '|';
      from = ends ? std::nullopt : std::optional(to);
    }
    left += c == '.' ? kAdvanceOfPoint : kAdvance;
  }
}

}  // namespace emax
