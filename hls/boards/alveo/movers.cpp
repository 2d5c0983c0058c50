// The data movers of an Alveo card. Run in C simulation only, never by the vendor's tools or on a
// card.
#include "hls/boards/alveo/movers.h"

#include "hls/kernel/command_words.h"

// Streams are the last arguments. The host names the others by their numbers, which then do not
// depend on whether a tool counts streams.

extern "C" void emax_to_core(const emax::Word* memory, emax::Word count, emax::Word reset,
                             emax::Stream<emax::Word>& commands, emax::Stream<emax::Word>& resets) {
  EMAX_HLS(INTERFACE m_axi port = memory offset = slave bundle = gmem)
  EMAX_HLS(INTERFACE s_axilite port = memory)
  EMAX_HLS(INTERFACE s_axilite port = count)
  EMAX_HLS(INTERFACE s_axilite port = reset)
  EMAX_HLS(INTERFACE axis port = commands)
  EMAX_HLS(INTERFACE axis port = resets)
  EMAX_HLS(INTERFACE s_axilite port = return )
  if (reset != 0) {
    resets.write(reset);
  }
  for (emax::Word i = 0; i < count; ++i) {
    EMAX_HLS(PIPELINE II = 1)
    commands.write(memory[i]);
  }
}

extern "C" void emax_from_core(emax::Word* memory, emax::Word answers, emax::Word payload,
                               emax::Word capacity, emax::Word patience,
                               emax::Stream<emax::Word>& from_core) {
  EMAX_HLS(INTERFACE m_axi port = memory offset = slave bundle = gmem)
  EMAX_HLS(INTERFACE s_axilite port = memory)
  EMAX_HLS(INTERFACE s_axilite port = answers)
  EMAX_HLS(INTERFACE s_axilite port = payload)
  EMAX_HLS(INTERFACE s_axilite port = capacity)
  EMAX_HLS(INTERFACE s_axilite port = patience)
  EMAX_HLS(INTERFACE axis port = from_core)
  EMAX_HLS(INTERFACE s_axilite port = return )
  emax::Word moved = 0;
  emax::Word waited = 0;
  while ((answers != 0 || payload != 0) && moved < capacity && waited < patience) {
    EMAX_HLS(PIPELINE II = 1)
    emax::Word word = 0;
    if (from_core.read_nb(word)) {
      if (payload != 0) {
        --payload;
      } else {
        --answers;
        payload = emax::header_count(word);
      }
      memory[emax::kMovedHeader + moved] = word;
      ++moved;
      waited = 0;
    } else {
      ++waited;
    }
  }
  memory[emax::kMovedWords] = moved;
  memory[emax::kAnswersLeft] = answers;
  memory[emax::kPayloadLeft] = payload;
}
