#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/report/report_data.h"

namespace emax {

// The lines of a command's result: a name in a column of its own, and a text. Lines are printed as
// they are added. Those that the same command prints whenever it is given the same files are kept
// for the report.
class Facts {
 public:
  template <class... Arguments>
  void add(std::string_view name, fmt::format_string<Arguments...> format,
           Arguments&&... arguments) {
    std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
    print(name, text);
    kept_.push_back({std::string(name), std::move(text)});
  }

  // A line that depends on time, processor or device.
  template <class... Arguments>
  void add_passing(std::string_view name, fmt::format_string<Arguments...> format,
                   Arguments&&... arguments) {
    print(name, fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  const std::vector<NamedText>& kept() const { return kept_; }

  // Lines that are added while it is silent are not printed.
  void be_silent(bool silent) { silent_ = silent; }

 private:
  void print(std::string_view name, const std::string& text) const {
    if (!silent_) fmt::print("{:<14} {}\n", name, text);
  }

  std::vector<NamedText> kept_;
  bool silent_ = false;
};

}  // namespace emax
