#pragma once

#include "host/app/machines.h"

namespace emax {

// The program `emax` with the arguments of main. Returns its exit code.
int run_program(int argc, char** argv, const Machines& machines = {});

}  // namespace emax
