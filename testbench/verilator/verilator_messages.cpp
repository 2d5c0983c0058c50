#include "testbench/verilator/verilator_messages.h"

#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

namespace {

struct Errors {
  ~Errors() {
    if (count <= kShownErrors) return;
    std::fprintf(stderr, "%lu more %%Error lines of the simulated hardware are not shown\n",
                 count - kShownErrors);
  }
  std::atomic<unsigned long> count{0};
};

Errors& errors() {
  static Errors all;
  return all;
}

}  // namespace

unsigned long emax_verilator_errors() { return errors().count; }

int emax_verilator_printf(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, again);
  va_end(again);
  std::vector<char> text(length < 0 ? 1 : static_cast<std::size_t>(length) + 1);
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  const std::string line(text.data());
  if (line.find("Verilog $stop") != std::string::npos) return length;
  if (line.find("%Error") != std::string::npos && ++errors().count > kShownErrors) {
    return length;
  }
  return std::fputs(line.c_str(), stdout);
}
