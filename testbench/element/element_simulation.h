// The four streams of the element (hls/rtl/emax_element.sv), one clock cycle at a time, for any
// Verilated variant of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "hls/kernel/triangle_record.h"
#include "hls/kernel/word.h"

namespace emax {

// The least number of cycles between two pairs of one point, unless the later pair is the point's
// first.
constexpr std::uint32_t kReadModifyWrite = 5;
constexpr std::uint32_t kPointBits = 10;
constexpr std::uint32_t kDeviceSlotBits = 4;  // the element as it is built into devices
constexpr std::uint32_t kPairsSlotBits = 8;   // sustains a different record in every cycle

using RecordWords = std::array<Word, kRecordWords>;

// A beat of s_axis_point.
struct Pair {
  std::array<Word, 3> point;
  Word index;
  bool first, final, next_record, last;

  bool operator==(const Pair&) const = default;
};

// The registered outputs in the present cycle.
struct ElementOutputs {
  bool record_ready, pair_ready;
  bool nearest_valid, nearest_last;
  bool worst_valid;
  Word nearest;
  Word worst_squared, worst_index;
};

class ElementSimulation {
 public:
  virtual ~ElementSimulation() = default;

  virtual std::uint32_t slot_bits() const = 0;
  virtual ElementOutputs outputs() const = 0;
  // Inputs of the present cycle; null is no beat. An input stays until it is set anew.
  virtual void offer_record(const RecordWords* record) = 0;
  virtual void offer_pair(const Pair* pair) = 0;
  virtual void set_ready(bool nearest, bool worst) = 0;
  // Lets the inputs settle without a clock edge.
  virtual void settle() = 0;
  // The rising edge that ends the present cycle; with `reset`, aresetn is low at it.
  virtual void clock(bool reset = false) = 0;
  // Whether an assertion of the design has failed since the start.
  virtual bool assertion_failed() const = 0;
  // Sets the active mutant; 0 is the unchanged design. Throws std::logic_error where the build has
  // no mutants.
  virtual void set_mutant(std::uint32_t mutant) = 0;
};

}  // namespace emax
