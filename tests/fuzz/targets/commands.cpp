// The device in software, given any words.
#include <array>
#include <cstring>

#include "sw_model/base/error.h"
#include "sw_model/protocol/cpp_device.h"
#include "tests/fuzz/target.h"

namespace emax::fuzz {
namespace {

// The cycle model takes time for each record that a header announces, so headers announce few.
constexpr Word kMostRecords = 0xff;

// All that the device answers when the words come in parts of so many.
std::vector<Word> answers(std::span<const Word> words, std::size_t part) {
  CppDevice device;
  while (!words.empty()) {
    const auto now = words.first(std::min(part, words.size()));
    device.send(now);
    words = words.subspan(now.size());
  }
  std::vector<Word> answered;
  try {
    for (std::array<Word, 1> word;; answered.push_back(word[0])) device.receive(word);
  } catch (const Error&) {  // the end of the answers
    return answered;
  }
}

}  // namespace

void read(Input input) {
  std::vector<Word> words(input.size() / sizeof(Word));
  if (!words.empty()) std::memcpy(words.data(), input.data(), words.size() * sizeof(Word));
  for (Word& word : words) {
    if (header_opcode(word) == kRecords) {
      word = command_header(kRecords, header_count(word) & kMostRecords);
    }
  }
  const std::vector<Word> answered = answers(words, words.size() + 1);
  require(answers(words, 1) == answered, "the cuts of the stream change nothing");
  for (std::size_t at = 0; at < answered.size(); at += 1 + header_count(answered[at])) {
    require(at + header_count(answered[at]) < answered.size(), "an answer is as long as it says");
  }
}

std::vector<std::string> seeds() {
  const Vector3<float> points[] = {{0, 0, 0}, {1, 0, 0}};
  TriangleRecord<float> record = {};
  std::vector<Word> words = {command_header(kIdentify, 0), command_header(kCounters, 0)};
  append_load_points(words, points);
  append_records(words, {&record, 1});
  append_reduce(words, true);
  return {{reinterpret_cast<const char*>(words.data()), words.size() * sizeof(Word)}};
}

}  // namespace emax::fuzz
