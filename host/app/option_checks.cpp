#include "host/app/option_checks.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "host/files/number_text.h"
#include "host/files/spooled_input.h"

namespace emax {

CLI::Validator positive(const std::string& unit) {
  return {[unit](std::string& text) {
            const std::optional<double> value = parse_double(text);
            if (value && *value > 0 && std::isfinite(*value)) return std::string();
            return fmt::format("'{}': give a number of {} above 0", text, unit);
          },
          ""};
}

CLI::Validator within(double least, double greatest) {
  return {[least, greatest](std::string& text) {
            const std::optional<double> value = parse_double(text);
            if (value && *value >= least && *value <= greatest) return std::string();
            return fmt::format("'{}': give a number from {} to {}", text, least, greatest);
          },
          fmt::format("in [{} - {}]", least, greatest)};
}

CLI::Validator whole() {
  return {[](std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto read = std::from_chars(text.data(), end, value);
            if (read.ec == std::errc{} && read.ptr == end) return std::string();
            return fmt::format("'{}': give a whole number from 0 to {}", text, UINT64_MAX);
          },
          ""};
}

CLI::Validator not_negative() {
  return {[](std::string& text) {
            return text.starts_with('-') ? fmt::format("'{}' is negative", text) : std::string();
          },
          ""};
}

CLI::Validator not_empty() {
  return {[](std::string& text) { return std::string(text.empty() ? "is empty" : ""); }, ""};
}

CLI::Validator standard_input_by_one_name() {
  return {[](std::string& text) {
            if (text == "/dev/stdin") text = kStandardInput;
            return std::string();
          },
          ""};
}

bool is_utf8(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace emax
