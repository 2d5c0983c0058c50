#include "sw_model/protocol/cpp_device.h"

#include "sw_model/base/error.h"

namespace emax {

template <class Pair>
void CppCore<Pair>::send(std::span<const Word> words) {
  while (!words.empty()) {
    const CommandCursor::Part part = cursor_.take(words);
    if (part.begins) account(part.header);
    for (const Word word : part.words) commands_.write(word);
    if (part.ends) kernel_.serve(commands_, answers_);
  }
}

template <class Pair>
void CppCore<Pair>::receive(std::span<Word> words) {
  if (answers_.size() < words.size()) {
    throw Error(
        "device sim: waiting for an answer that no command asked for; this is a defect of "
        "the program");
  }
  for (Word& word : words) word = answers_.read();
}

template <class Pair>
void CppCore<Pair>::account(Word header) {
  const Word count = header_count(header);
  switch (header_opcode(header)) {
    case Pair::kLoad:
      cycles_.load_points(count);
      break;
    case Pair::kMeet:
      cycles_.stream_records(count);
      break;
    case Pair::kAnswer:
      cycles_.reduce((count & kReduceListsPoints) != 0);
      break;
    case kIdentify:
      cycles_.answer(kAnswerIdentity);
      break;
    case kCounters:
      cycles_.answer(0);
      break;
    default:
      break;
  }
}

template <class Pair>
DeviceCounters CppCore<Pair>::counters() const {
  DeviceCounters counters;
  counters.cycles = cycles_.cycles();
  counters.busy = cycles_.busy();
  counters.stalled = cycles_.stalled();
  return counters;
}

template class CppCore<ExactPair<FlushedFloat>>;
template class CppCore<FilterPair>;

}  // namespace emax
