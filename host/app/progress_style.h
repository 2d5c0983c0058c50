#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace emax {

// How the commands tell of their progress on standard error.
enum class ProgressStyle {
  kText,  // lines for a person
  kJson,  // a line of JSON for each change
  kNone,
};

// Throws std::out_of_range for another name than text, json and none.
ProgressStyle progress_style_named(std::string_view name);

// Of this process; kText until it is set.
void set_progress_style(ProgressStyle style);
ProgressStyle progress_style();

// Writes the object as one line; a number that is not finite is null.
void tell_progress(const nlohmann::ordered_json& change);

}  // namespace emax
