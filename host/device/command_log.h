#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "sw_model/protocol/commands.h"

namespace emax {

// Keeps the commands whose answers a device still owes, so that all of them can be sent again to a
// device that has lost its state. Gives each answer only once, and only whole. The commands that
// must be sent again together are a unit: those up to a Reduce of either core, which ends a block,
// or a single question outside any block. What earlier units stored is kept, too, and is stored
// again before them.
class CommandLog {
 public:
  // Adds words of commands, cut anywhere.
  void append(std::span<const Word> words);

  std::size_t unsent() const { return unsent_; }
  // The next unsent words, at most `most`; they then count as sent.
  std::vector<Word> take(std::size_t most);
  // Makes every kept word unsent again. Answers then come again from the first kept unit on.
  void rewind();

  // Adds words of answers, cut anywhere. Returns false if no command that was sent asks for them.
  bool add_answers(std::span<const Word> words);
  std::size_t due() const { return due_; }             // answers that are not yet whole
  std::size_t ready() const { return ready_.size(); }  // words of whole answers
  void give(std::span<Word> words);                    // gives such words; words.size() <= ready()

 private:
  struct Unit {
    std::vector<Word> words;
    std::vector<std::size_t> questions;  // for each command with an answer, its end in `words`
    std::size_t sent = 0;                // words
    std::size_t answered = 0;            // of `questions`, since the last rewind
    std::size_t delivered = 0;           // of `questions`, over all time
    bool complete = false;
  };

  bool finish_answer();
  void keep_stored(const std::vector<Word>& commands);
  void append_stored(std::vector<Word>& commands) const;

  std::deque<Unit> units_;  // only the last one may be incomplete
  CommandCursor cursor_{CommandSet::kBoard};
  // The words of the store after the units that are gone, those that any unit wrote; and what is to
  // be sent of them, before all units, with the number of words sent.
  std::vector<Word> stored_;
  std::vector<bool> is_stored_;
  std::vector<Word> restore_;
  std::size_t restored_ = 0;
  std::size_t unsent_ = 0, due_ = 0;
  std::vector<Word> answer_;  // the answer that is arriving
  std::size_t answer_missing_ = 0;
  std::deque<Word> ready_;
};

}  // namespace emax
