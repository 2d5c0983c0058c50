#include "host/device/command_log.h"

#include <algorithm>

namespace emax {

void CommandLog::append(std::span<const Word> words) {
  unsent_ += words.size();
  while (!words.empty()) {
    const CommandCursor::Part part = cursor_.take(words);
    if (part.begins && (units_.empty() || units_.back().complete)) units_.emplace_back();
    Unit& unit = units_.back();
    const bool alone = unit.words.empty();
    unit.words.insert(unit.words.end(), part.words.begin(), part.words.end());
    if (!part.ends || !is_answered(part.header)) continue;
    unit.questions.push_back(unit.words.size());
    unit.complete = header_opcode(part.header) == kReduce || alone;
    ++due_;
  }
}

std::vector<Word> CommandLog::take(std::size_t most) {
  std::vector<Word> taken;
  for (Unit& unit : units_) {
    const std::size_t count = std::min(unit.words.size() - unit.sent, most - taken.size());
    const auto start = unit.words.begin() + static_cast<std::ptrdiff_t>(unit.sent);
    taken.insert(taken.end(), start, start + static_cast<std::ptrdiff_t>(count));
    unit.sent += count;
  }
  unsent_ -= taken.size();
  return taken;
}

void CommandLog::rewind() {
  unsent_ = 0;
  for (Unit& unit : units_) {
    unit.sent = unit.answered = 0;
    unsent_ += unit.words.size();
  }
  answer_.clear();
  answer_missing_ = 0;
}

bool CommandLog::add_answers(std::span<const Word> words) {
  for (const Word word : words) {
    if (answer_missing_ == 0) answer_missing_ = 1 + header_count(word);
    answer_.push_back(word);
    if (--answer_missing_ == 0 && !finish_answer()) return false;
  }
  return true;
}

bool CommandLog::finish_answer() {
  if (units_.empty()) return false;
  Unit& unit = units_.front();
  if (unit.answered == unit.questions.size() || unit.sent < unit.questions[unit.answered]) {
    return false;
  }
  if (++unit.answered > unit.delivered) {
    unit.delivered = unit.answered;
    ready_.insert(ready_.end(), answer_.begin(), answer_.end());
    --due_;
  }
  answer_.clear();
  if (unit.complete && unit.answered == unit.questions.size()) units_.pop_front();
  return true;
}

void CommandLog::give(std::span<Word> words) {
  const auto end = ready_.begin() + static_cast<std::ptrdiff_t>(words.size());
  std::copy(ready_.begin(), end, words.begin());
  ready_.erase(ready_.begin(), end);
}

}  // namespace emax
