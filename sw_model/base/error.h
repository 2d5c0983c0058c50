#pragma once

#include <stdexcept>
#include <string>

namespace emax {

// What a person can mend: the message is one line that names the file (and its line or vertex) and
// the remedy. The program prints it and ends with exit code 1.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

// The device is at fault and not the work: whatever is asked of it next fails too.
class DeviceFailure : public Error {
 public:
  using Error::Error;
};

// Thrown out of work whose caller asked it to end.
struct Interrupted {};

}  // namespace emax
