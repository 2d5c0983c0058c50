#include "host/app/standard_streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "sw_model/base/error.h"

namespace emax {

void open_standard_streams() {
  int lowest = 0;  // open() gives the lowest free number
  do {
    lowest = open("/dev/null", O_RDWR);
  } while (lowest >= 0 && lowest <= STDERR_FILENO);
  if (lowest >= 0) close(lowest);
}

void silence_standard_output() {
  std::fflush(stdout);
  const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nothing < 0) throw Error(fmt::format("/dev/null cannot be opened: {}", std::strerror(errno)));
  dup2(nothing, STDOUT_FILENO);
  close(nothing);
}

void to_standard_error(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

bool standard_error_is_terminal() { return isatty(STDERR_FILENO) == 1; }

std::string fit_terminal(std::string line) {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1) {
    line.resize(std::min<std::size_t>(line.size(), size.ws_col - 1u));
  }
  return line;
}

}  // namespace emax
