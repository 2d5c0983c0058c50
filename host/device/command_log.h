#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "sw_model/protocol/commands.h"

namespace emax {

// The commands that a device still owes answers to, kept so that all of them can be sent again to a
// device that has forgotten everything, and the answers, which are given only whole and only once.
//
// What must be sent again together is a unit: the commands up to a Reduce, which ends a block, or a
// question outside any block by itself.
class CommandLog {
 public:
  // Words of commands, cut anywhere.
  void append(std::span<const Word> words);

  std::size_t unsent() const { return unsent_; }
  // The next unsent words, at most so many; they then count as sent.
  std::vector<Word> take(std::size_t most);
  // Every kept word is unsent again, and answers come again from the first kept unit on.
  void rewind();

  // Words of answers, cut anywhere. False where no command that was sent asks for them.
  bool add_answers(std::span<const Word> words);
  std::size_t due() const { return due_; }             // answers not yet whole
  std::size_t ready() const { return ready_.size(); }  // words of whole answers
  void give(std::span<Word> words);                    // of those; words.size() <= ready()

 private:
  struct Unit {
    std::vector<Word> words;
    std::vector<std::size_t> questions;  // the end in `words` of each command that answers
    std::size_t sent = 0;                // words
    std::size_t answered = 0;            // of `questions`, since the latest rewind
    std::size_t delivered = 0;           // of `questions`, ever
    bool complete = false;
  };

  bool finish_answer();

  std::deque<Unit> units_;  // only the last one may be incomplete
  CommandCursor cursor_;
  std::size_t unsent_ = 0, due_ = 0;
  std::vector<Word> answer_;  // the one that is arriving
  std::size_t answer_missing_ = 0;
  std::deque<Word> ready_;
};

}  // namespace emax
