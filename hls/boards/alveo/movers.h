// The two data movers beside the core on an Alveo card: HLS kernels between the card's memory and
// the core's streams. Run in C simulation only, never by the vendor's tools or on a card.
#pragma once

#include "hls/kernel/hls_target.h"
#include "hls/kernel/word.h"

// What emax_from_core leaves at the start of its memory; the words moved follow.
namespace emax {
constexpr Word kMovedWords = 0;    // number of words that were moved
constexpr Word kAnswersLeft = 1;   // answers that are still to begin
constexpr Word kPayloadLeft = 2;   // words missing of the answer that has begun
constexpr Word kMovedHeader = 16;  // words before the first word moved, so that it is aligned
}  // namespace emax

// Resets the core where `reset` is not 0, then gives it `count` command words of `memory`.
extern "C" void emax_to_core(const emax::Word* memory, emax::Word count, emax::Word reset,
                             emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& resets);

// Moves answer words from the core to `memory`: `payload` words that are missing of an answer, then
// `answers` whole answers, each of a length that its header gives (an error is shorter than the
// result that was asked for). Ends sooner after `capacity` words or after `patience` clock cycles
// without a word, so it ends whatever the core does; kAnswersLeft and kPayloadLeft then go into the
// next call.
extern "C" void emax_from_core(emax::Word* memory, emax::Word answers, emax::Word payload,
                               emax::Word capacity, emax::Word patience,
                               emax::Stream<emax::Word>& from_core);
