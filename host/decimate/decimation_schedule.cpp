#include "host/decimate/decimation_schedule.h"

#include <array>

namespace emax {
namespace {

using Effort = DecimationSettings::Effort;

constexpr std::size_t kFew = 400;  // triangles: with so few, searching on takes hardly any time
// The passes' shares of the time that is estimated to be left.
constexpr double kSweeps = 0.4, kOtherPass = 0.3;
// Power of the distances in the energy that places vertices.
constexpr int kPower = 4;
// Another power changes the energy, and so moves the mesh out of a local minimum.
constexpr std::array<int, 3> kOtherPowers = {2, 8, 6};

class Schedule {
 public:
  Schedule(DecimationState& state, DecimationPasses::Options options,
           const DecimationSettings& settings)
      : state_(state),
        settings_(settings),
        lowers_energy_(settings.objective == DecimationSettings::Objective::kHoppe),
        weight_(lowers_energy_ || settings.effort == Effort::kSweep ? 1 : kSweeps),
        passes_(state, std::move(options), [this](double done) { return advance(done); }) {}

  bool run() {
    if (lowers_energy_) {
      tell("descent", passes_.descend());
      return !passes_.stopped();
    }
    tell("sweeps", passes_.sweep());
    if (settings_.effort != Effort::kSweep) tell("collapses", passes_.collapse());
    const bool goes_on =
        settings_.effort != Effort::kSweep && settings_.effort != Effort::kCollapse;
    if (goes_on && !passes_.stopped()) improve();
    return !passes_.stopped();
  }

 private:
  // Returning true ends the passes.
  bool advance(double done) {
    if (settings_.advanced) settings_.advanced(begun_ + weight_ * done, state_.mesh().triangles());
    return settings_.interrupted && settings_.interrupted();
  }

  std::size_t tell(const char* pass, std::size_t edits) {
    if (settings_.progress) settings_.progress(pass, edits, state_.mesh().triangles());
    begun_ += weight_;
    weight_ = (1 - begun_) * (settings_.effort == Effort::kCollapse ? 1 : kOtherPass);
    return edits;
  }

  void relocate(int power) { tell("relocations", passes_.relocate(power)); }
  void flip(int power) { tell("flips", passes_.flip(power)); }

  // Returns the number of collapses that flips and relocations made possible.
  std::size_t relax() {
    flip(kPower);
    relocate(kPower);
    return tell("collapses", passes_.collapse());
  }

  // Tries collapses that need the vertices around them moved: once, or with `deep` until nothing is
  // gained. Returns whether anything was gained.
  bool mend(bool deep) {
    bool any = false;
    for (bool again = true; again && !passes_.stopped();) {
      state_.reassign();
      const std::size_t mended = tell("mended collapses", passes_.collapse_and_mend());
      const bool gained = mended + relax() > 0;
      any = any || gained;
      again = gained && deep;
    }
    return any;
  }

  void improve() {
    state_.reassign();
    relocate(kPower);
    relax();
    const bool deep = settings_.effort == Effort::kDeep || state_.mesh().triangles() <= kFew;
    mend(deep);
    const std::size_t tries = deep ? kOtherPowers.size() : 1;
    for (std::size_t vain = 0; vain < tries && !passes_.stopped();) {
      const int power = kOtherPowers[vain++];
      flip(power);
      relocate(power);
      relocate(kPower);
      if (mend(deep) && deep) vain = 0;
    }
  }

  DecimationState& state_;
  const DecimationSettings& settings_;
  bool lowers_energy_;
  double begun_ = 0, weight_;  // shares of the work: done, and of the present pass
  DecimationPasses passes_;
};

}  // namespace

bool run_passes(DecimationState& state, DecimationPasses::Options options,
                const DecimationSettings& settings) {
  return Schedule(state, std::move(options), settings).run();
}

}  // namespace emax
