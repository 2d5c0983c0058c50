#pragma once

#include <array>
#include <deque>
#include <vector>

#include "hls/kernel/command_words.h"
#include "host/device/opencl_program.h"
#include "sw_model/protocol/commands.h"

namespace emax {

// Serves commands on an OpenCL device. The queue keeps their order, so one set of buffers is
// enough; answers are kept until they are asked for.
class OpenclDevice::Commands {
 public:
  explicit Commands(const OpenclChoice& choice);
  ~Commands();

  const OpenclProgram& opencl() const { return opencl_; }

  void take(const CommandCursor::Part& part);
  void give(std::span<Word> words);

 private:
  // An answer that is due: its words, or a block whose minima are on their way.
  struct Answer {
    std::vector<Word> words;
    bool list_points = false;
    std::vector<Word> nearest = {};
    std::deque<std::vector<Word>> sent = {};  // what the transfers of the block read
    cl::Event arrived = {};
  };

  void answer(std::vector<Word> words) { asked_.push_back({std::move(words)}); }
  void load_points();
  void write(const cl::Buffer& buffer, std::vector<Word> words);
  void gather_records(std::span<const Word> words);
  void meet_gathered();
  void reduce(bool list_points);
  void finish_oldest();

  OpenclProgram opencl_;
  cl::Kernel meet_;
  std::array<cl::Buffer, 3> axes_;
  cl::Buffer records_, nearest_;
  std::vector<Word> points_, gathered_;  // words of commands that are not on the device yet
  std::deque<std::vector<Word>> sent_;   // since the last block, and read by transfers
  std::size_t count_ = 0;                // points of the block
  Word error_ = kNoError;
  std::deque<Answer> asked_;
  std::deque<Word> answers_;
};

}  // namespace emax
