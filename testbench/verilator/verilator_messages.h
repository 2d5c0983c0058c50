// Everything that Verilator's runtime prints passes this function: its sources are compiled with
// VL_PRINTF set to it (cmake/emax_verilate.cmake).
//
// A design that hangs, or the shrinking of a failure, breaks one assertion again and again. The
// first kShownErrors lines with %Error are printed. The others are counted, and the program says at
// its end, on standard error, how many there were. "Verilog $stop" is never printed: it follows
// each of these lines and tells nothing more.
#pragma once

constexpr unsigned long kShownErrors = 3;

// Lines with %Error so far, shown or not.
unsigned long emax_verilator_errors();

int emax_verilator_printf(const char* format, ...) __attribute__((format(printf, 1, 2)));
