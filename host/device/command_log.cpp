#include "host/device/command_log.h"

#include <algorithm>

#include "host/device/stored_items.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {

void CommandLog::append(std::span<const Word> words) {
  unsent_ += words.size();
  while (!words.empty()) {
    const CommandCursor::Part part = cursor_.take(words);
    if (part.begins && (units_.empty() || units_.back().complete)) units_.emplace_back();
    Unit& unit = units_.back();
    const bool alone = unit.words.empty();
    unit.words.insert(unit.words.end(), part.words.begin(), part.words.end());
    if (!part.ends || !is_answered(part.header, CommandSet::kBoard)) continue;
    unit.questions.push_back(unit.words.size());
    const Word opcode = header_opcode(part.header);
    unit.complete = opcode == kReduce || opcode == kFilterReduce || alone;
    ++due_;
  }
}

std::vector<Word> CommandLog::take(std::size_t most) {
  const std::size_t again = std::min(most, restore_.size() - restored_);
  const auto from = restore_.begin() + static_cast<std::ptrdiff_t>(restored_);
  std::vector<Word> taken(from, from + static_cast<std::ptrdiff_t>(again));
  restored_ += again;
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
  restore_.clear();
  restored_ = 0;
  if (!EMAX_FAULT(kLogForgetsStored)) append_stored(restore_);
  unsent_ = restore_.size();
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
  if (unit.complete && unit.answered == unit.questions.size()) {
    keep_stored(unit.words);
    units_.pop_front();
  }
  return true;
}

void CommandLog::keep_stored(const std::vector<Word>& commands) {
  CommandCursor cursor(CommandSet::kBoard);
  for (std::span<const Word> rest = commands; !rest.empty();) {
    const CommandCursor::Part part = cursor.take(rest);
    if (header_opcode(part.header) != kStore || part.words.size() < 2) continue;
    const auto words = part.words.subspan(2);
    const std::size_t address = part.words[1];
    const std::size_t end = std::max(stored_.size(), address + words.size());
    stored_.resize(end);
    is_stored_.resize(end);
    for (std::size_t i = 0; i < words.size(); ++i) {
      stored_[address + i] = words[i];
      is_stored_[address + i] = true;
    }
  }
}

void CommandLog::append_stored(std::vector<Word>& commands) const {
  for (std::size_t i = 0; i < stored_.size();) {
    std::size_t end = i;
    while (end < stored_.size() && is_stored_[end]) ++end;
    if (end > i) append_store(commands, i, std::span(stored_).subspan(i, end - i));
    i = std::max(end, i + 1);
  }
}

void CommandLog::give(std::span<Word> words) {
  const auto end = ready_.begin() + static_cast<std::ptrdiff_t>(words.size());
  std::copy(ready_.begin(), end, words.begin());
  ready_.erase(ready_.begin(), end);
}

}  // namespace emax
