#pragma once

#include <optional>
#include <vector>

#include "hls/kernel/emax_top.h"
#include "sw_model/base/flush_mode.h"

namespace emax {

// Runs the synthesizable top on the processor's own binary32 until all command words are served.
// Returns the answer words. `flushing` is off only in tests that show that its absence is caught.
inline std::vector<Word> run_top(const std::vector<Word>& words, bool flushing = true) {
  std::optional<ScopedFlushMode> flush;
  if (flushing) flush.emplace();
  Stream<Word> commands, answers;
  for (const Word word : words) commands.write(word);
  while (!commands.empty()) emax_top(commands, answers);
  std::vector<Word> all;
  while (!answers.empty()) all.push_back(answers.read());
  return all;
}

}  // namespace emax
