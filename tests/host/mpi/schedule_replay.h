#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace emax::test {

struct Replay {
  double seconds;     // until the last evaluation has completed
  double efficiency;  // the share of that time in which the workers work
};

// A search whose evaluations take `costs` seconds, in the order of their candidates, by
// RankDispatch on ranks with so many workers. Candidate i is there when the results up to
// i - look_ahead are; `message` seconds pass between a result and the next evaluation of its
// worker.
Replay replay_schedule(std::span<const double> costs, const std::vector<unsigned>& workers,
                       std::size_t look_ahead, double message);

}  // namespace emax::test
