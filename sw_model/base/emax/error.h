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
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace v1
}  // namespace emax
