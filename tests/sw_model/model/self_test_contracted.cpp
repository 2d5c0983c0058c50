#include "sw_model/model/arithmetic_probe.h"

namespace emax::test {

// Defined apart from the test: this file is compiled with contraction allowed.
std::optional<std::string> probe_with_contraction() { return probe_arithmetic(); }

}  // namespace emax::test
