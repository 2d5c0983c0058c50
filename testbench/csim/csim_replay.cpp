// C simulation where only a C++14 compiler is at hand, as in HLS tools: replays words that
// `emax_csim --words FILE` wrote through the synthesizable top. Exit code 0 when all agree.
//
//   csim_replay FILE
//
// FILE has a line for each block: the number of command words, the words, the number of expected
// answer words, the words; all in hexadecimal.

#include <cstdio>
#include <fstream>
#include <ios>
#include <vector>

#include "hls/kernel/emax_top.h"
#include "sw_model/base/flush_mode.h"

namespace {

bool read_words(std::istream& in, std::vector<emax::Word>& words) {
  std::size_t count = 0;
  if (!(in >> count)) return false;
  words.resize(count);
  for (emax::Word& word : words) in >> word;
  return static_cast<bool>(in);
}

}  // namespace

int main(int argc, char** argv) {
  std::ifstream in(argc == 2 ? argv[1] : "");
  if (!in) {
    std::fprintf(stderr, "usage: csim_replay FILE, written by emax_csim --words FILE\n");
    return 2;
  }
  in >> std::hex;
  unsigned long blocks = 0, words = 0, mismatches = 0;
  std::vector<emax::Word> sent, expected;
  while (!(in >> std::ws).eof()) {
    if (!read_words(in, sent) || !read_words(in, expected)) {
      std::fprintf(stderr, "%s: block %lu is cut off; write the file again\n", argv[1], blocks);
      return 2;
    }
    emax::Stream<emax::Word> commands, answers;
    for (const emax::Word word : sent) commands.write(word);
    {
      const emax::ScopedFlushMode flush;
      while (!commands.empty()) emax_top(commands, answers);
    }
    for (const emax::Word word : expected) {
      if (!answers.empty() && answers.read() == word) continue;
      if (mismatches++ == 0) std::printf("block %lu: expected %08x\n", blocks, word);
    }
    if (!answers.empty()) ++mismatches;
    while (!answers.empty()) answers.read();
    words += expected.size();
    ++blocks;
  }
  std::printf("csim_replay: %lu blocks, %lu answer words, %lu mismatches\n", blocks, words,
              mismatches);
  return blocks > 0 && mismatches == 0 ? 0 : 1;
}
