#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hls/kernel/command_words.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The command layer from the host's side: values to words and back.
void append_load_points(std::vector<Word>& words, std::span<const Vector3<float>> points);
void append_records(std::vector<Word>& words, std::span<const TriangleRecord<float>> records);
void append_reduce(std::vector<Word>& words, bool list_points);

// The number of words that follow a command's header.
std::size_t payload_words(Word header);
// Whether the command is answered; a command that is answered has no payload.
bool is_answered(Word header);

// Finds the commands in a stream of words that arrives in parts of any length.
class CommandCursor {
 public:
  struct Part {
    std::span<const Word> words;  // of one command, its header included
    Word header;
    bool begins, ends;  // whether the command begins or ends in this part
  };
  // Removes the next part from `words`, which is not empty.
  Part take(std::span<const Word>& words);

 private:
  Word header_ = 0;
  std::size_t missing_ = 0;  // words of the present command that are still to come
};

struct ReduceAnswer {
  std::uint32_t squared_bits;
  std::uint32_t worst;                             // index in the block
  std::vector<std::uint32_t> points_squared_bits;  // empty unless listed
};

// Waits for the answer to a kReduce over `points` points. Throws Error where the device answers
// with an error or out of step.
ReduceAnswer receive_reduce(Device& device, std::size_t points, bool list_points);

// Asks for the device's cycles and adds them to `counters`; a device that does not count them
// leaves them as they are. No other answer is under way. Throws Error where it answers out of step.
void ask_cycles(Device& device, DeviceCounters& counters);

// Asks the device for its identity. Throws Error for another kernel version or record layout.
void require_compatible(Device& device);

}  // namespace emax
