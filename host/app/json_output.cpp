#include "host/app/json_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "host/files/atomic_file.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr const char* kStandardOutput = "-";

int json_descriptor = -1;  // the original standard output

[[noreturn]] void fail() {
  throw Error(fmt::format("standard output cannot be written: {}; name a file to --json",
                          std::strerror(errno)));
}

}  // namespace

void direct_json(std::string& json) {
  if (json != kStandardOutput) return;
  json.clear();
  json_descriptor = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (json_descriptor < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) fail();
}

bool standard_output_is_json() { return json_descriptor >= 0; }

bool json_is_wanted(const std::string& file) { return !file.empty() || standard_output_is_json(); }

void write_json(const std::string& file, std::string_view bytes) {
  if (!file.empty()) {
    write_atomically(file, bytes);
    return;
  }
  while (!bytes.empty()) {
    const ssize_t written = write(json_descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace emax
