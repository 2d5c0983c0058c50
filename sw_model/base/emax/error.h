#pragma once

#include <stdexcept>
#include <string>

// Marks what the shared library exports.
#define EMAX_API [[gnu::visibility("default")]]

namespace emax {
inline namespace v1 {

// The exception of every public function, for faults that a caller can correct. Its text is one
// line that names the argument, or the file and its line or vertex, and the remedy. The program
// prints it and ends with exit code 1. Public functions throw nothing else but std::bad_alloc and
// what a callback of the caller throws.
class EMAX_API Error : public std::runtime_error {
 public:
  // Control characters, which parts of a file may bring into a message, become '?'.
  explicit Error(std::string message) : std::runtime_error(one_line(message)) {}

 private:
  static const std::string& one_line(std::string& message) {
    for (char& c : message) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 || byte == 0x7f) c = '?';
    }
    return message;
  }
};

}  // namespace v1
}  // namespace emax
