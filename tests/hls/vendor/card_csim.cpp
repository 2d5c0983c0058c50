// C simulation of a card's kernels with the streams of AMD's HLS tools, as their C++14: the movers
// around the C++ core carry a question there and its answers back. Its exit code is its verdict;
// with an argument, the host asks for one answer too many.
#include <cstdio>

#include "hls/boards/alveo/movers.h"
#include "hls/kernel/command_words.h"

extern "C" void emax_core_kernel(emax::Stream<emax::Word>& s_axis_command,
                                 emax::Stream<emax::Word>& s_axis_reset,
                                 emax::Stream<emax::Word>& m_axis_answer);

int main(int argc, char**) {
  using namespace emax;
  const bool fault = argc > 1;
  // Who is there; a result without a block, which is an error; a block without records.
  const Word commands[] = {command_header(kIdentify, 0),
                           command_header(kReduce, kReduceListsPoints),
                           command_header(kLoadPoints, 1),
                           0,
                           0,
                           0,
                           command_header(kReduce, kReduceListsPoints)};
  const Word expected[] = {command_header(kIdentify, kAnswerIdentity),
                           kKernelVersion,
                           kMaxBlockPoints,
                           kRecordWords,
                           1,
                           0,
                           command_header(kError, 1),
                           kNoPoints,
                           command_header(kReduce, kAnswerWorst + 1),
                           0x7f800000,
                           0x7f800000,
                           0};
  const Word count = sizeof expected / sizeof expected[0];

  Stream<Word> to_core, resets, from_core;
  emax_to_core(commands, sizeof commands / sizeof commands[0], 1, to_core, resets);
  for (int i = 0; i < 10; ++i) emax_core_kernel(to_core, resets, from_core);

  Word memory[kMovedHeader + count + 1] = {};
  emax_from_core(memory, fault ? 4 : 3, 0, count + 1, 100, from_core);
  int mismatches = 0;
  for (Word i = 0; i < count; ++i) {
    if (memory[kMovedHeader + i] != expected[i]) ++mismatches;
  }
  const bool complete = memory[kMovedWords] == count && memory[kAnswersLeft] == 0 &&
                        memory[kPayloadLeft] == 0 && resets.empty() && to_core.empty();
  std::printf("card csim: %u words, %u answers left, %d mismatches\n", memory[kMovedWords],
              memory[kAnswersLeft], mismatches);
  return complete && mismatches == 0 ? 0 : 1;
}
