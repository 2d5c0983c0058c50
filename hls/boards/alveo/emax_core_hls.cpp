// The C++ top as a kernel of a card that runs without being started by a host. It stands in for the
// RTL core with the same name and ports and one element. Run in C simulation only, never by the
// vendor's tools or on a card. A reset is taken between commands and changes nothing, because a
// LoadPoints begins anew anyway. A core that waits for the rest of a command waits for ever.
#include "hls/kernel/emax_kernel.h"

extern "C" void emax_core_kernel(emax::Stream<emax::Word>& s_axis_command,
                                 emax::Stream<emax::Word>& s_axis_reset,
                                 emax::Stream<emax::Word>& m_axis_answer) {
  EMAX_HLS(INTERFACE axis port = s_axis_command)
  EMAX_HLS(INTERFACE axis port = s_axis_reset)
  EMAX_HLS(INTERFACE axis port = m_axis_answer)
  EMAX_HLS(INTERFACE ap_ctrl_none port = return )
  static emax::EmaxKernel<float> kernel;
  emax::Word reset = 0;
  s_axis_reset.read_nb(reset);
  if (!s_axis_command.empty()) {
    kernel.serve(s_axis_command, m_axis_answer);
  }
}
