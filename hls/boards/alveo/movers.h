// The two data movers beside the core on an Alveo card: HLS kernels between the card's memory and
// the core's streams. Run in C simulation only, never by the vendor's tools or on a card.
#pragma once

#include "hls/kernel/hls_target.h"
#include "hls/kernel/word.h"

// Words that emax_from_core writes at the start of its memory; the moved words follow.
namespace emax {
constexpr Word kMovedWords = 0;    // number of words that were moved
constexpr Word kAnswersLeft = 1;   // answers that are still to begin
constexpr Word kPayloadLeft = 2;   // words of the present answer that are still to come
constexpr Word kMovedHeader = 16;  // words before the first moved word, which keep it aligned
}  // namespace emax

// Resets the core where `reset` is not 0, then gives it `count` command words of `memory`.
extern "C" void emax_to_core(const emax::Word* memory, emax::Word count, emax::Word reset,
                             emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& resets);

// Moves answer words from the core to `memory`: first `payload` words that complete an answer, then
// `answers` whole answers. The header of an answer gives its length, because an error is shorter
// than the result that was asked for. Ends early after `capacity` words, or after `patience` clock
// cycles without a word, so it ends whatever the core does. The next call then takes kAnswersLeft
// and kPayloadLeft as its `answers` and `payload`.
extern "C" void emax_from_core(emax::Word* memory, emax::Word answers, emax::Word payload,
                               emax::Word capacity, emax::Word patience,
                               emax::Stream<emax::Word>& from_core);
