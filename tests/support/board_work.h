#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "sw_model/model/triangle_frame.h"
#include "sw_model/protocol/byte_channel.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cpp_device.h"
#include "tests/support/stimuli.h"

namespace emax::test {

// A board that a test talks to, and how much work it is given.
struct Board {
  std::unique_ptr<ByteChannel> channel;
  std::function<void()> power_cycle;
};
struct BoardKind {
  std::string name;
  std::size_t blocks, points, records;
  std::function<Board()> make;

  // GoogleTest calls it by this name. NOLINTNEXTLINE(readability-identifier-naming)
  friend void PrintTo(const BoardKind& kind, std::ostream* out) { *out << kind.name; }
};

using Block = std::vector<Word>;  // its commands

// Blocks of points and records of a bumpy sphere; every second one lists its points, and some
// questions stand between them.
inline std::vector<Block> some_blocks(const BoardKind& kind, std::uint64_t seed) {
  const Stimulus s = bumpy_sphere(12, 16, kind.blocks * kind.points, seed);
  const Normalization normalization = normalization_of(s.cloud);
  const auto points = normalized_points(s.cloud, normalization);
  const auto records = make_records(s.mesh(), normalization);
  std::vector<Block> blocks(kind.blocks);
  for (std::size_t i = 0; i < kind.blocks; ++i) {
    if (i % 3 == 1) blocks[i].push_back(command_header(kIdentify, 0));
    append_load_points(blocks[i], std::span(points).subspan(i * kind.points, kind.points));
    append_records(blocks[i], std::span(records).first(kind.records - i % 7));
    append_reduce(blocks[i], i % 2 == 0);
  }
  return blocks;
}

inline void receive_answer(Device& device, std::vector<Word>& answers) {
  std::vector<Word> header(1);
  device.receive(header);
  std::vector<Word> rest(header_count(header[0]));
  device.receive(rest);
  // Elements and clock are a device's own.
  if (header[0] == command_header(kIdentify, kAnswerIdentity)) rest.resize(rest.size() - 2);
  answers.push_back(header[0]);
  answers.insert(answers.end(), rest.begin(), rest.end());
}

// All answers of a device to the blocks, of which four are under way at a time.
inline std::vector<Word> answers_of(Device& device, const std::vector<Block>& blocks) {
  std::vector<Word> answers;
  std::size_t collected = 0;
  const auto collect = [&] {
    if (header_opcode(blocks[collected++][0]) == kIdentify) receive_answer(device, answers);
    receive_answer(device, answers);
  };
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i - collected == 4) collect();
    device.send(blocks[i]);
  }
  while (collected < blocks.size()) collect();
  return answers;
}

inline std::vector<Word> undisturbed_answers(const std::vector<Block>& blocks) {
  CppDevice sim;
  return answers_of(sim, blocks);
}

}  // namespace emax::test
