#include "host/app/progress_style.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "host/app/standard_streams.h"

namespace emax {
namespace {

ProgressStyle style_of_process = ProgressStyle::kText;

}  // namespace

ProgressStyle progress_style_named(std::string_view name) {
  static const std::map<std::string_view, ProgressStyle> styles = {{"text", ProgressStyle::kText},
                                                                   {"json", ProgressStyle::kJson},
                                                                   {"none", ProgressStyle::kNone}};
  return styles.at(name);
}

void set_progress_style(ProgressStyle style) { style_of_process = style; }
ProgressStyle progress_style() { return style_of_process; }

void tell_progress(const nlohmann::ordered_json& change) {
  to_standard_error(change.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                    "\n");
}

}  // namespace emax
