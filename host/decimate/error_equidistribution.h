#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "host/decimate/decimation_passes.h"
#include "host/decimate/race.h"

namespace emax {

// Spreads the error evenly over a mesh, which then needs fewer triangles for the same greatest
// error. The sum of the p-th powers of the distances evens them out for high p. A collapse puts
// much error in one place, which only later moves around it carry away; so the limits are loosened
// while triangles are taken where they cost least and added where the error is greatest. In the end
// the limits hold again, and what is beyond them is split and relaxed
// (docs/decisions/0020-the-error-spread-evenly.md).
class ErrorEquidistribution {
 public:
  // Told of each pass: its name, the number of edits.
  using Tell = std::function<void(const char*, std::size_t)>;
  // How long it goes on: at most so many exchanges of triangles, the last ones with higher powers,
  // rounds of flips and relocations with powers of 32 and 64, and thinnings.
  struct Extent {
    int exchanges, last_exchanges;
    int rounds, last_rounds;
    int thinnings;
  };
  static constexpr Extent kShort = {2, 2, 2, 2, 2}, kLong = {6, 4, 4, 3, 20};
  ErrorEquidistribution(DecimationState& state, DecimationPasses& passes, const Extent& extent,
                        Race& race, Tell tell)
      : state_(state), passes_(passes), extent_(extent), race_(race), tell_(std::move(tell)) {}

  // Returns whether every limit holds in the end. If not, not all could be restored, the passes
  // were stopped, or the race was lost before. A race that is lost later ends the thinnings.
  bool run();
  // Where the limits could not be restored.
  const std::vector<DecimationPasses::Place>& stuck() const { return stuck_; }

 private:
  bool lost(Race::At at) { return race_.lost(at, state_.mesh().triangles()); }
  void relax(int power, int rounds);
  void relax_around(const std::vector<std::uint32_t>& slots, int power);
  void exchange(double quantile, double share, double collapsed, int power);
  void exchange_at_last();
  std::size_t fitting(double quantile);
  std::vector<std::uint32_t> beyond_limit();
  bool restore(double most);
  bool restore_loosely(double most, double few);
  bool restore_exactly();
  void repair();
  bool are_many(double beyond, double share) const;
  bool is_slow(const std::vector<std::size_t>& fewest) const;
  bool thin();
  std::vector<std::uint32_t> still_beyond();
  void note_stuck(const std::vector<std::uint32_t>& slots);

  DecimationState& state_;
  DecimationPasses& passes_;
  const Extent extent_;
  Race& race_;
  Tell tell_;
  std::vector<DecimationPasses::Place> stuck_;
};

}  // namespace emax
