#include "testbench/core/board_stimuli.h"

#include <algorithm>
#include <span>

#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cpp_board.h"

namespace emax::test {
namespace {

// A command whose payload is stored and then recalled, in pieces that are stored in any order.
void append_recalled(std::vector<Word>& words, std::span<const Word> command, unsigned store_bits,
                     Random& random) {
  const Word size = 1u << store_bits;
  std::vector<Word> pieces;
  Word address = static_cast<Word>(random.below(size));
  auto payload = command.subspan(1);
  while (!payload.empty()) {
    const std::size_t length =
        std::min<std::size_t>({1 + random.below(40), payload.size(), kMaxPieceWords});
    if (payload.size() < size) {  // longer commands name the same words more than once
      words.push_back(command_header(kStore, static_cast<Word>(1 + length)));
      words.push_back(address % size);
      words.insert(words.end(), payload.begin(),
                   payload.begin() + static_cast<std::ptrdiff_t>(length));
    }
    pieces.push_back(store_piece(address % size, static_cast<Word>(length)));
    address += static_cast<Word>(length);
    payload = payload.subspan(length);
  }
  words.push_back(command_header(kRecall, static_cast<Word>(1 + pieces.size())));
  words.push_back(command[0]);
  words.insert(words.end(), pieces.begin(), pieces.end());
}

}  // namespace

std::vector<Word> any_board_block(const Material& exact, const FilterMaterial& filter,
                                  BlockSize size, unsigned store_bits, Random& random) {
  const bool listed = random.one_in(2);
  const auto plain = random.one_in(2)
                         ? dense_block(exact, size.points, size.records, listed, random)
                         : filter_block(filter, size.points, size.records, listed, random);
  std::vector<Word> words;
  std::span<const Word> block = plain;
  CommandCursor cursor(CommandSet::kBoard);
  while (!block.empty()) {
    const auto command = cursor.take(block).words;
    if (random.one_in(2)) {
      words.insert(words.end(), command.begin(), command.end());
    } else {
      append_recalled(words, command, store_bits, random);
    }
  }
  return words;
}

std::vector<Word> any_board_commands(const Material& exact, const FilterMaterial& filter,
                                     std::size_t count, unsigned store_bits, Random& random) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t points = 1 + random.below(60), records = random.below(6);
    const auto block = any_board_block(exact, filter, {points, records}, store_bits, random);
    words.insert(words.end(), block.begin(), block.end());
    if (random.one_in(4)) words.push_back(command_header(kIdentify, kOfStore));
    if (random.one_in(4)) {
      words.insert(words.end(), {command_header(kEcho, 2), static_cast<Word>(i), 0xabcdef01u});
    }
    if (random.one_in(8)) words.push_back(command_header(kEcho, 0));
    if (random.one_in(8)) words.push_back(command_header(kRecall, 0));
    if (random.one_in(8)) words.insert(words.end(), {command_header(kStore, 1), 3});
    if (random.one_in(8)) words.push_back(command_header(kFilterReduce, 0));  // without a block
    if (random.one_in(8)) words.push_back(0x7f000003);                        // unknown
  }
  // Faults that are remembered are answered here.
  words.insert(words.end(), {command_header(kReduce, 0), command_header(kFilterReduce, 0)});
  return words;
}

std::vector<Word> answers_of_board(std::span<const Word> words, unsigned store_bits) {
  CppBoard board(1, 1, store_bits);
  board.send(words);
  std::vector<Word> answers;
  std::size_t questions = 0;
  CommandCursor cursor(CommandSet::kBoard);
  for (auto rest = words; !rest.empty();) {
    const auto part = cursor.take(rest);
    const bool recalls = header_opcode(part.header) == kRecall && part.words.size() > 1;
    questions += is_answered(recalls ? part.words[1] : part.header, CommandSet::kCores) ? 1 : 0;
  }
  for (; questions > 0; --questions) {
    std::vector<Word> answer(1);
    board.receive(answer);
    answer.resize(1 + header_count(answer[0]));
    board.receive(std::span(answer).subspan(1));
    answers.insert(answers.end(), answer.begin(), answer.end());
  }
  return answers;
}

}  // namespace emax::test
