#include "testbench/core/core_driver.h"

#include "hls/kernel/emax_kernel.h"
#include "sw_model/base/error.h"
#include "sw_model/model/flushed_float.h"

namespace emax {
namespace {

constexpr std::uint64_t kPatience = 1u << 18;  // cycles in which no word moves
// A word taken shows in under_way at the latest so many cycles later.
constexpr std::uint64_t kSettled = 16;

}  // namespace

std::vector<Word> run_core(CoreSimulation& core, std::span<const Word> words,
                           const CorePatterns& patterns, std::uint64_t* cycles) {
  PatternSource commands(patterns.commands, patterns.seed);
  PatternSource answers(patterns.answers, patterns.seed + 1);
  std::vector<Word> answered;
  std::size_t sent = 0;
  bool offering = false;
  std::uint64_t still = 0;
  while (true) {
    offering = sent < words.size() && (offering || commands.next());
    const bool ready = answers.next();
    core.offer_command(offering ? &words[sent] : nullptr);
    core.set_answer_ready(ready);
    const CoreOutputs now = core.outputs();
    ++still;
    if (offering && now.command_ready) {
      ++sent;
      offering = false;
      still = 0;
    }
    if (ready && now.answer_valid) {
      answered.push_back(now.answer);
      still = 0;
    }
    if (sent == words.size() && !now.under_way && still > kSettled) return answered;
    core.clock();
    if (cycles != nullptr) ++*cycles;
    if (core.assertion_failed()) throw Error("core: an assertion of the design failed");
    if (still > kPatience) throw Error("core: it hangs");
  }
}

namespace {

template <class Kernel>
std::vector<Word> answers_of(std::span<const Word> words) {
  const auto kernel = std::make_unique<Kernel>();
  Stream<Word> commands, answers;
  for (const Word word : words) commands.write(word);
  while (!commands.empty()) kernel->serve(commands, answers);
  std::vector<Word> answered;
  while (!answers.empty()) answered.push_back(answers.read());
  return answered;
}

}  // namespace

std::vector<Word> answers_of_kernel(std::span<const Word> words) {
  return answers_of<EmaxKernel<FlushedFloat>>(words);
}

std::vector<Word> answers_of_filter(std::span<const Word> words) {
  return answers_of<FilterKernel>(words);
}

}  // namespace emax
