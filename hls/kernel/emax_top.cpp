#include "hls/kernel/emax_top.h"

#include "hls/kernel/emax_kernel.h"

// Plain binary32: flushing subnormals is the target's own (hardware operators, or the processor's
// flush mode set by the testbench).
extern "C" void emax_top(emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& answers) {
  EMAX_HLS(INTERFACE axis port = commands)
  EMAX_HLS(INTERFACE axis port = answers)
  EMAX_HLS(INTERFACE ap_ctrl_hs port = return )
  static emax::EmaxKernel<float> kernel;
  kernel.serve(commands, answers);
}
