#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hls/kernel/word.h"

namespace emax {

// The answers that are still to come from the core: `payload` words of an answer that has begun,
// then `answers` whole answers.
struct AnswersDue {
  Word answers = 0;
  Word payload = 0;
  bool operator==(const AnswersDue&) const = default;
};

// The words that one run of the mover from the core brought, and the answers that are still due.
struct MovedAnswers {
  std::vector<Word> words;
  AnswersDue left;
};

// The two data movers of an accelerator card (hls/boards/alveo/movers.h), as the host controls
// them. Each mover works in parallel with the host, one run after the other.
class CardMovers {
 public:
  static constexpr std::size_t kSlots =
      2;  // buffers to the core; one fills while the other is moved

  virtual ~CardMovers() = default;

  virtual std::string name() const = 0;
  // Starts to move `words` to the core, after a reset of the core if `reset` is true. The slot must
  // be free.
  virtual void start_write(std::size_t slot, std::span<const Word> words, bool reset) = 0;
  // Waits at most `wait` for the slot's transfer to end; returns whether it has ended.
  virtual bool written(std::size_t slot, std::chrono::milliseconds wait) = 0;
  // Starts to move answers from the core. No run may be in progress. The run always ends: when all
  // answers due have come, when its buffer is full, or when no word has come for about the time
  // `patience`.
  virtual void start_read(const AnswersDue& due, std::chrono::milliseconds patience) = 0;
  // Waits at most `wait` for the run to end; returns nothing if it has not.
  virtual std::optional<MovedAnswers> read(std::chrono::milliseconds wait) = 0;
};

}  // namespace emax
