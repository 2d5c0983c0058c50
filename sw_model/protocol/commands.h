#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hls/kernel/command_words.h"
#include "hls/kernel/filter_words.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The command layer from the host's side: values to words and back.
void append_load_points(std::vector<Word>& words, std::span<const Vector3<float>> points);
void append_records(std::vector<Word>& words, std::span<const TriangleRecord<float>> records);
void append_reduce(std::vector<Word>& words, bool list_points);
// The same for a filtering core.
void append_filter_points(std::vector<Word>& words, std::span<const Vector3<FilterNumber>> points);
void append_filter_records(std::vector<Word>& words,
                           std::span<const TriangleRecord<FilterNumber>> records);
void append_filter_reduce(std::vector<Word>& words, bool list_points);

// Whose commands they are: a core's, which does not know those that make a block of the other one;
// a board's, with those of the store; or those that a board's store gives to its two cores, where
// Identify of the store is followed by its answer.
enum class CommandSet { kExact, kFilter, kBoard, kCores };

// The number of words that follow a command's header.
std::size_t payload_words(Word header, CommandSet set = CommandSet::kExact);
// Whether the command is answered; of those that are, kEcho alone has a payload. A kRecall counts
// as not answered: nobody here makes a command that is answered of words of a store.
bool is_answered(Word header, CommandSet set = CommandSet::kExact);

// Finds the commands in a stream of words that arrives in parts of any length.
class CommandCursor {
 public:
  explicit CommandCursor(CommandSet set = CommandSet::kExact) : set_(set) {}

  struct Part {
    std::span<const Word> words;  // of one command, its header included
    Word header;
    bool begins, ends;  // whether the command begins or ends in this part
  };
  // Removes the next part from `words`, which is not empty.
  Part take(std::span<const Word>& words);

 private:
  CommandSet set_;
  Word header_ = 0;
  std::size_t missing_ = 0;  // words of the present command that are still to come
};

struct ReduceAnswer {
  std::uint32_t squared_bits;
  std::uint32_t worst;                             // index in the block
  std::vector<std::uint32_t> points_squared_bits;  // empty unless listed
};

// Waits for the answer to a kReduce over `points` points, or to a kFilterReduce, whose results
// stand where squared distances are. Throws Error where the device answers with an error or out of
// step.
ReduceAnswer receive_reduce(Device& device, std::size_t points, bool list_points,
                            Opcode question = kReduce);

// Asks for the device's cycles and adds them to `counters`; a device that does not count them
// leaves them as they are. No other answer is under way. Throws Error where it answers out of step.
void ask_cycles(Device& device, DeviceCounters& counters);

// The number of words of a board's store. Throws Error where the device is no board of this
// version.
std::size_t require_store(Device& device);

// Asks the device for its identity. Throws Error for another kernel version or record layout.
void require_compatible(Device& device);
// The same for a filtering core.
void require_filter(Device& device);

}  // namespace emax
