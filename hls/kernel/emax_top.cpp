#include "hls/kernel/emax_top.h"

#include "hls/kernel/emax_kernel.h"

// Plain binary32: the target flushes subnormals (by the hardware operators, or by the processor's
// flush mode that the testbench sets).
extern "C" void emax_top(emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& answers) {
  EMAX_HLS(INTERFACE axis port = commands)
  EMAX_HLS(INTERFACE axis port = answers)
  EMAX_HLS(INTERFACE ap_ctrl_hs port = return )
  static emax::EmaxKernel<float> kernel;
  kernel.serve(commands, answers);
}
