#pragma once

#include <cstddef>

namespace emax {

// A decimation beside the result of another one, its rival, that it is to beat. It is lost where
// the passes that are left will hardly leave fewer triangles: each leaves a share of what there is,
// within bounds that were measured (docs/decisions/0021-candidates-race.md).
class Race {
 public:
  enum class At {
    kCollapsed,  // all collapses within the limits are made
    kExchanged,  // the error is spread evenly, the limits are to be restored
    kRestored,   // the limits hold again
    kUneven,     // all collapses are made, and the error cannot be spread
  };

  // `rival`: its triangles; 0: none, and the race is never lost.
  explicit Race(std::size_t rival) : rival_(rival) {}

  // Returns whether the race is lost, now or before.
  bool lost(At at, std::size_t triangles);
  bool lost() const { return expected_ > 0; }

  // The triangles that would have been left in the end, estimated when the race was lost and more
  // than the rival's; 0 where it was not lost.
  std::size_t expected() const { return expected_; }

 private:
  std::size_t rival_;
  std::size_t expected_ = 0;
};

}  // namespace emax
