#include "host/files/las_reference_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "host/files/number_text.h"

namespace emax {
namespace {

std::uint16_t key_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint16_t value;
  std::memcpy(&value, &bytes[at], sizeof value);
  return value;
}

std::optional<Unit> unit_of_code(std::uint16_t code) {  // of EPSG
  switch (code) {
    case 9001:
      return unit_named("m");
    case 9002:
      return unit_named("ft");
    case 9003:
      return unit_named("us-ft");
    default:
      return std::nullopt;
  }
}

// Files round the US survey foot, which is 2e-6 longer than the foot.
std::optional<Unit> unit_of_metres(double metres) {
  const auto* const unit = std::ranges::find_if(
      kUnits, [&](const Unit& known) { return std::abs(metres / known.metres - 1) < 1e-7; });
  return unit == kUnits.end() ? std::nullopt : std::optional(*unit);
}

bool is_any(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

bool is_flat(std::string_view word) {
  return is_any(word, {"PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS", "ENGINEERINGCRS",
                       "GEOCCS"});
}
bool is_round(std::string_view word) {
  return is_any(word, {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"});
}
bool is_upright(std::string_view word) {
  return is_any(word, {"VERT_CS", "VERTCRS", "VERTICALCRS"});
}

// Walks through KEYWORD["text", number, KEYWORD[...], ...].
class TextReader {
 public:
  LasLengths read(std::string_view text) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      const char c = text[at];
      if (c == '"') {
        const std::size_t end = std::min(text.find('"', at + 1), text.size());
        at = end;
      } else if (c == '[' || c == '(') {
        open();
      } else if (c == ',') {
        end_value();
      } else if (c == ']' || c == ')') {
        end_value();
        close();
      } else if (static_cast<unsigned char>(c) > ' ') {
        value_ += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
      }
    }
    found_.angles = round_ && !flat_;
    return found_;
  }

 private:
  struct Node {
    std::string keyword;
    std::size_t values = 0;
    std::string second;
  };

  void open() {
    flat_ = flat_ || is_flat(value_);
    round_ = round_ || is_round(value_);
    nodes_.push_back({std::move(value_), 0, {}});
    value_.clear();
  }

  void end_value() {
    if (!nodes_.empty() && ++nodes_.back().values == 2) nodes_.back().second = value_;
    value_.clear();
  }

  void close() {
    if (nodes_.empty()) return;
    const Node node = std::move(nodes_.back());
    nodes_.pop_back();
    if (!is_any(node.keyword, {"UNIT", "LENGTHUNIT"}) || nodes_.empty()) return;
    // A unit is said of the whole system, or of its axes.
    std::string_view of = nodes_.back().keyword;
    if (of == "AXIS" && nodes_.size() > 1) of = nodes_[nodes_.size() - 2].keyword;
    const std::optional<double> metres = parse_double(node.second);
    if (!metres) return;
    if (is_flat(of) && !found_.unit) found_.unit = unit_of_metres(*metres);
    if (is_upright(of) && !found_.heights) found_.heights = unit_of_metres(*metres);
  }

  std::vector<Node> nodes_;
  std::string value_;
  bool flat_ = false, round_ = false;
  LasLengths found_;
};

}  // namespace

LasLengths lengths_of_keys(std::span<const std::uint8_t> keys) {
  constexpr std::uint16_t kModel = 1024, kLinearUnits = 3076, kHeightUnits = 4099, kGeographic = 2;
  LasLengths lengths;
  for (std::size_t at = 8; at + 8 <= keys.size(); at += 8) {
    const std::uint16_t value = key_at(keys, at + 6);
    switch (key_at(keys, at)) {
      case kModel:
        lengths.angles = value == kGeographic;
        break;
      case kLinearUnits:
        lengths.unit = unit_of_code(value);
        break;
      case kHeightUnits:
        lengths.heights = unit_of_code(value);
        break;
      default:
        break;
    }
  }
  return lengths;
}

LasLengths lengths_of_text(std::string_view text) { return TextReader().read(text); }

}  // namespace emax
