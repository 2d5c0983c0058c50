#include "sw_model/model/self_test.h"

#include "sw_model/base/error.h"
#include "sw_model/model/arithmetic_probe.h"

namespace emax {

void verify_arithmetic() {
  if (const std::optional<std::string> fault = probe_arithmetic()) {
    throw Error("arithmetic self-test: " + *fault +
                "; no result of this program could be trusted, so none is made");
  }
}

}  // namespace emax
