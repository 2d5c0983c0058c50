#pragma once

#include <emax/error.h>

namespace emax {

// The device is at fault, not the work: every later request to it fails too.
class DeviceFailure : public Error {
 public:
  using Error::Error;
};

// Thrown by work whose caller asked it to end.
struct Interrupted {};

}  // namespace emax
