// What the Verilated runtime prints goes through here: its sources are compiled with VL_PRINTF set
// to this function (cmake/emax_verilate.cmake).
//
// A design that hangs or a search that tries hundreds of variants of a failure breaks one assertion
// again and again. The first kShownErrors lines with %Error are printed; the others are counted,
// and at its end the program tells on standard error how many there were. "Verilog $stop" is not
// printed at all: it follows each of them and says nothing more.
#pragma once

constexpr unsigned long kShownErrors = 3;

// Lines with %Error so far, shown or not.
unsigned long emax_verilator_errors();

int emax_verilator_printf(const char* format, ...) __attribute__((format(printf, 1, 2)));
