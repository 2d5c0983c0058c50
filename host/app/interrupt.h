#pragma once

namespace emax {

// From now on the first Ctrl-C or SIGTERM is only noted; the second ends the program.
void note_interrupts();
bool was_interrupted();

inline constexpr int kExitOk = 0;
inline constexpr int kExitError = 1;  // bad input or a failure; one line gives cause and remedy
inline constexpr int kExitNo = 2;     // the answer is no: infeasible, or not verified
inline constexpr int kExitInterrupted = 130;  // as the shell reports Ctrl-C

}  // namespace emax
