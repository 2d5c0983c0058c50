#pragma once

#include "host/decimate/chain_parameters.h"

namespace emax {

// Methods "test.*" that fail the way libraries do; known only to a worker that was started with
// --allow-test-methods. Returns when the method is none of them.
//   test.crash   aborts                       test.garbage   writes bytes that are no message
//   test.exit    ends with exit code 3        test.strange   answers another ticket
//   test.hang    never answers                test.huge      announces an absurd length
//   test.memory  allocates without end        test.error     throws Error
//   test.print   prints on stdout and throws Error
// A parameter "test.fault" of 1 to 4 makes a sound method crash, hang, allocate without end or
// write garbage, so that a search meets faults among sound evaluations.
void run_test_method(const ChainSettings& settings, int channel);

}  // namespace emax
