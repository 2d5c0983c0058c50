#include "sw_model/protocol/cpp_board.h"

#include <array>

#include "sw_model/base/error.h"

namespace emax {

CppBoard::CppBoard(std::uint32_t exact_elements, std::uint32_t filter_elements, unsigned store_bits)
    : exact_(exact_elements), filter_(filter_elements), store_(std::size_t{1} << store_bits) {}

void CppBoard::send(std::span<const Word> words) {
  while (!words.empty()) {
    const CommandCursor::Part part = cursor_.take(words);
    command_.insert(command_.end(), part.words.begin(), part.words.end());
    if (!part.ends) continue;
    perform(command_);
    command_.clear();
  }
}

void CppBoard::receive(std::span<Word> words) {
  if (answers_.size() < words.size()) {
    throw Error(
        "device sim: waiting for an answer that no command asked for; this is a defect of "
        "the program");
  }
  for (Word& word : words) {
    word = answers_.front();
    answers_.pop_front();
  }
}

void CppBoard::perform(std::span<const Word> command) {
  const Word header = command[0];
  const auto payload = command.subspan(1);
  if (header_opcode(header) == kStore) {
    for (std::size_t i = 1; i < payload.size(); ++i) {
      store_[(payload[0] + i - 1) % store_.size()] = payload[i];
    }
  } else if (header_opcode(header) == kRecall) {
    recall(payload);
  } else if (header == command_header(kIdentify, kOfStore)) {
    pass(std::array<Word, 3>{header, kStoreVersion, static_cast<Word>(store_.size())});
  } else {
    pass(command);
  }
}

void CppBoard::recall(std::span<const Word> payload) {
  if (payload.empty()) return;
  std::vector<Word> made = {payload[0]};
  for (const Word piece : payload.subspan(1)) {
    for (Word i = 0; i < piece_words(piece); ++i) {
      made.push_back(store_[(piece_address(piece) + i) % store_.size()]);
    }
  }
  pass(made);
}

// Words to the cores. Those that a recall gives need not be whole commands.
void CppBoard::pass(std::span<const Word> words) {
  while (!words.empty()) {
    const CommandCursor::Part part = passed_.take(words);
    for_cores_.insert(for_cores_.end(), part.words.begin(), part.words.end());
    if (!part.ends) continue;
    route(for_cores_);
    for_cores_.clear();
  }
}

void CppBoard::route(std::span<const Word> command) {
  const Word opcode = header_opcode(command[0]), option = header_count(command[0]);
  const bool of_cores = opcode == kIdentify || opcode == kCounters;
  if (opcode == kEcho || (opcode == kIdentify && option == kOfStore)) {
    answers_.insert(answers_.end(), command.begin(), command.end());
  } else if (opcode == kFilterPoints || opcode == kFilterRecords || opcode == kFilterReduce ||
             (of_cores && option == kOfFilter)) {
    ask(filter_, command);
  } else {
    ask(exact_, command);
  }
}

template <class Core>
void CppBoard::ask(Core& core, std::span<const Word> command) {
  core.send(command);
  if (!is_answered(command[0], CommandSet::kCores)) return;
  std::vector<Word> answer(1);
  core.receive(answer);
  if (answer[0] == command_header(kCounters, 0)) {
    const DeviceCounters counts = core.counters();
    answer[0] = command_header(kCounters, kAnswerCounters);
    for (const std::uint64_t count : {*counts.busy, *counts.stalled, std::uint64_t{0}}) {
      answer.push_back(static_cast<Word>(count));
      answer.push_back(static_cast<Word>(count >> 32));
    }
  } else {
    answer.resize(1 + header_count(answer[0]));
    core.receive(std::span(answer).subspan(1));
  }
  answers_.insert(answers_.end(), answer.begin(), answer.end());
}

}  // namespace emax
