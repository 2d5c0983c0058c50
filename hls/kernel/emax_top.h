// The synthesizable top function: serves one command per call, state kept on chip.
#pragma once

#include "hls/kernel/hls_target.h"
#include "hls/kernel/word.h"

extern "C" void emax_top(emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& answers);
