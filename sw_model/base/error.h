#pragma once

#include <emax/error.h>

namespace emax {

// The device is at fault and not the work: whatever is asked of it next fails too.
class DeviceFailure : public Error {
 public:
  using Error::Error;
};

// Thrown out of work whose caller asked it to end.
struct Interrupted {};

}  // namespace emax
