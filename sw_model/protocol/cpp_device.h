#pragma once

#include <memory>
#include <type_traits>

#include "hls/kernel/emax_kernel.h"
#include "sw_model/model/flushed_float.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/cycle_model.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The `sim` device: a C++ top with the cycle model of a core of the given number of elements.
// `Pair` is what a block's pairs are (hls/kernel/emax_kernel.h).
template <class Pair>
class CppCore : public Device {
 public:
  explicit CppCore(std::uint32_t elements = 1)
      : cursor_(kIsFilter ? CommandSet::kFilter : CommandSet::kExact),
        cycles_(elements, kIsFilter ? kFilterCore : kExactCore) {}

  std::string name() const override { return "sim"; }
  // Takes the stream of words in parts of any length; serves a command once all its words are
  // there.
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;

 private:
  static constexpr bool kIsFilter = std::is_same_v<Pair, FilterPair>;

  void account(Word header);

  BlockKernel<Pair> kernel_;
  Stream<Word> commands_, answers_;
  CommandCursor cursor_;
  CycleModel cycles_;
};

// The kernel on the flushing scalar.
using CppDevice = CppCore<ExactPair<FlushedFloat>>;
// A filtering core.
using CppFilter = CppCore<FilterPair>;

}  // namespace emax
