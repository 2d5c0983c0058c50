#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/emax_search/evaluator.h"
#include "sw_model/normalization.h"

namespace emax {

// The decimator's local test, asked of whoever evaluates the kernel, a device or the CPU: are these
// points of the cloud within epsilon of these triangles? Questions are independent, so a sweep's
// edits, which do not touch, may be asked together and keep a device busy.
struct BlockQuestion {
  std::vector<std::uint32_t> points;  // of the cloud, ascending, no more than 2^32
  std::vector<std::array<Point, 3>> triangles;
};

enum class BlockVerdict {
  kWithin,  // all of them, proven
  kBeyond,  // one is not, proven
  kOpen,    // the kernel's rounding leaves it open: ask in binary64
};

class BlockQuestions {
 public:
  // All in the unit of the cloud. Throws std::invalid_argument as normalization_of does. O(points).
  BlockQuestions(std::span<const Point> cloud, double epsilon);

  // A verdict each, the same from every evaluator. Points and triangles are cut into blocks as the
  // evaluator takes them, of which a few are under way at once. Throws std::invalid_argument for a
  // question without triangles and whatever the evaluator throws. O(sum of points by triangles).
  std::vector<BlockVerdict> ask(std::span<const BlockQuestion> questions,
                                Evaluator& evaluator) const;

 private:
  Normalization normalization_;
  std::vector<Vector3<float>> points_;
  double epsilon_;  // normalised
};

}  // namespace emax
