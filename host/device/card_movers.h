#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hls/kernel/word.h"

namespace emax {

// What is still to come from the core: whole answers, after the words missing of one that began.
struct AnswersDue {
  Word answers = 0;
  Word payload = 0;
  bool operator==(const AnswersDue&) const = default;
};

// What one run of the mover from the core brought, and what it leaves.
struct MovedAnswers {
  std::vector<Word> words;
  AnswersDue left;
};

// The two data movers of an accelerator card (hls/boards/alveo/movers.h) as the host sees them:
// each runs beside the host, one run after the other.
class CardMovers {
 public:
  static constexpr std::size_t kSlots =
      2;  // buffers to the core; one fills while the other is moved

  virtual ~CardMovers() = default;

  virtual std::string name() const = 0;
  // Starts to move `words` to the core, after a reset of the core if asked for. The slot is free.
  virtual void start_write(std::size_t slot, std::span<const Word> words, bool reset) = 0;
  // Waits until that has been done, so long at most: whether it has.
  virtual bool written(std::size_t slot, std::chrono::milliseconds wait) = 0;
  // Starts to move answers from the core. Ends when all that are due have come, when its buffer is
  // full or when no word has come for about the time of patience, so always. No run is under way.
  virtual void start_read(const AnswersDue& due, std::chrono::milliseconds patience) = 0;
  // Waits for its end, so long at most.
  virtual std::optional<MovedAnswers> read(std::chrono::milliseconds wait) = 0;
};

}  // namespace emax
