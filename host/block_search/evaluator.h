#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hls/kernel/triangle_record.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/protocol/device.h"

namespace emax {

// Work that the search could not settle: every point of a block meets every candidate.
struct Block {
  std::vector<std::uint32_t> points;      // indices into the cloud, ascending
  std::vector<std::uint32_t> candidates;  // indices into the records
};

struct BlockAnswer {
  // The lowest cloud index that attains the block's maximum. A filter may give the greatest answer
  // since begin() in its place, where no point of the block is as far.
  EmaxResult worst;
  std::vector<std::uint32_t> squared_bits;  // of every point, if the caller asked for them
};

// Evaluates the kernel on blocks: the SIMD evaluator or a device. Blocks may be prepared and
// submitted while earlier ones are computed; answers come in the order of the blocks.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  virtual std::string name() const = 0;
  virtual std::size_t block_points() const = 0;  // the most it takes in one block
  // Before begin(): an order of the next points in which those of a block are near each other, for
  // evaluators that keep points. It changes no answer.
  virtual void lay_out(std::span<const std::uint32_t> /*order*/) {}
  // Sets the points and records that blocks refer to. They must outlive the blocks' answers.
  virtual void begin(std::span<const Vector3<float>> points,
                     std::span<const TriangleRecord<float>> records) = 0;
  virtual void submit(const Block& block, bool list_points) = 0;
  virtual BlockAnswer collect() = 0;
  virtual DeviceCounters counters() const = 0;  // since construction
};

}  // namespace emax
