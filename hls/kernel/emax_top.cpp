// The synthesizable top function: one command per call, state kept on chip. Given to HLS compilers
// and compiled by the tests; flushing of subnormal results is the target's (docs/numerics.md).
#include "hls/kernel/emax_kernel.h"

extern "C" void emax_top(emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& answers) {
  EMAX_HLS(INTERFACE axis port = commands)
  EMAX_HLS(INTERFACE axis port = answers)
  EMAX_HLS(INTERFACE ap_ctrl_hs port = return )
  static emax::EmaxKernel<float> kernel;
  kernel.serve(commands, answers);
}
