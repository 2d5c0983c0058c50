// The stimuli lie in the testbench, which the co-simulation shares with the tests.
#pragma once

#include "testbench/stimuli/stimuli.h"
