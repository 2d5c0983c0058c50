#include "sw_model/base/flush_mode.h"

#include <stdexcept>
#include <string>

namespace emax {

void require_no_flush(const char* work) {
  if (flush_mode_is_on()) {
    throw std::logic_error(std::string(work) + " must not run with subnormals flushed");
  }
}

}  // namespace emax
