#include "sw_model/self_test.h"

#include "sw_model/arithmetic_probe.h"
#include "sw_model/error.h"

namespace emax {

void verify_arithmetic() {
  if (const std::optional<std::string> fault = probe_arithmetic()) {
    throw Error("arithmetic self-test: " + *fault +
                "; no result of this program could be trusted, so none is made");
  }
}

}  // namespace emax
