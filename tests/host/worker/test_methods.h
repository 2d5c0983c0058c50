#pragma once

#include "host/parameters/chain_parameters.h"

namespace emax::test {

// 1 to 4 makes a sound method crash, hang, allocate without end or write garbage, so that a search
// meets faults among sound evaluations.
inline constexpr ParameterKey<int> kFault{"test.fault", 0, 7, 7, "the way to fail"};

// Methods "test.*" that fail the way libraries do. Returns when the method is none of them.
//   test.crash   aborts                       test.garbage   writes bytes that are no message
//   test.exit    ends with exit code 3        test.strange   answers another ticket
//   test.hang    never answers                test.huge      announces an absurd length
//   test.memory  allocates without end        test.error     throws Error
//   test.print   prints on stdout, throws Error   test.flood   writes bytes without end
//   test.trickle announces bytes, then writes one every 0.2 s
//   test.nested  a message of arrays in arrays
//   test.full    has no memory left unless it is the first that its worker runs
//   test.null    aborts unless it is the first that its worker runs
void run_test_method(const ChainSettings& settings, int channel);

}  // namespace emax::test
