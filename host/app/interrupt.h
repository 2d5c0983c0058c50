#pragma once

namespace emax {

// From now on Ctrl-C and SIGTERM are noted instead of ending the program; a second one ends it.
void note_interrupts();
bool was_interrupted();

inline constexpr int kExitOk = 0;
inline constexpr int kExitError = 1;  // bad input or a failure: one line says what and the remedy
inline constexpr int kExitNo = 2;     // the answer is no: infeasible, or not verified
inline constexpr int kExitInterrupted = 130;  // as the shell reports Ctrl-C

}  // namespace emax
