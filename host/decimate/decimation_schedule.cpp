#include "host/decimate/decimation_schedule.h"

#include <array>
#include <optional>
#include <utility>

#include "host/decimate/error_equidistribution.h"
#include "host/decimate/race.h"

namespace emax {
namespace {

using Effort = DecimationSettings::Effort;

constexpr std::size_t kFew = 400;  // triangles: with so few, searching on takes hardly any time
// The passes' shares of the time that is estimated to be left.
constexpr double kSweeps = 0.4, kOtherPass = 0.3, kPassOfMany = 0.03;
constexpr int kPower = DecimationPasses::kPower;
// Where the error is spread evenly.
constexpr int kHighPower = 16;
// With this share of the triangles left, nothing else is tried.
constexpr double kMuch = 0.85;
constexpr int kSpreads = 3;  // of spreading the error
// A vertex that comes nearer to its place makes room for those around it.
constexpr int kMostRoundsIntoPlace = 8;
// Toward the true edges: at first with room made for them, where errors are spread to the limit.
constexpr int kRoundsWithRoom = 20, kMostRoundsToEdges = 40, kPowerForRoom = 8;
// Another power changes the energy, and so moves the mesh out of a local minimum.
constexpr std::array<int, 3> kOtherPowers = {2, 8, 6};

class Schedule {
 public:
  Schedule(DecimationState& state, DecimationPasses::Options options,
           const DecimationSettings& settings)
      : state_(state),
        settings_(settings),
        lowers_energy_(settings.objective == DecimationSettings::Objective::kHoppe),
        race_(settings.rival),
        weight_(lowers_energy_ || settings.effort == Effort::kSweep ? 1 : kSweeps),
        passes_(state, std::move(options), settings.threads,
                [this](double done) { return advance(done); }) {}

  ScheduledMesh run() {
    if (lowers_energy_) {
      tell("descent", passes_.descend());
      return {state_.mesh().compact(), !passes_.stopped(), 0};
    }
    sweep();
    if (settings_.effort != Effort::kSweep) collapse();
    if (state_.follows_shapes() && settings_.effort != Effort::kSweep) settle_on_planes();
    if (goes_on() && !passes_.stopped() && !lost(Race::At::kCollapsed)) {
      const bool done = may_even_out() ? equidistribute() : lost(Race::At::kUneven);
      if (!done) improve();
    }
    move_into_place();
    if (settings_.effort != Effort::kSweep && !race_.lost()) move_toward_edges();
    TriangleMesh mesh = state_.mesh().compact();
    if (kept_ && kept_->triangles.size() < mesh.triangles.size()) mesh = std::move(*kept_);
    return {std::move(mesh), !passes_.stopped(), race_.expected()};
  }

 private:
  bool goes_on() const {
    return settings_.effort != Effort::kSweep && settings_.effort != Effort::kCollapse;
  }

  bool lost(Race::At at) { return race_.lost(at, state_.mesh().triangles()); }

  // Returning true ends the passes.
  bool advance(double done) {
    if (settings_.advanced) settings_.advanced(begun_ + weight_ * done, state_.mesh().triangles());
    return settings_.interrupted && settings_.interrupted();
  }

  std::size_t tell(const char* pass, std::size_t edits) {
    if (settings_.progress) settings_.progress(pass, edits, state_.mesh().triangles());
    begun_ += weight_;
    weight_ = (1 - begun_) * (settings_.effort == Effort::kCollapse ? 1 : pass_share_);
    return edits;
  }

  // A sweep leaves hardly ever a triangle of the reference that cannot be proven, as it stays far
  // below the limit; so the proofs are made at its end.
  void sweep() {
    const DecimationState::Snapshot before = state_.snapshot();
    const FeatureEdges features = passes_.features();
    state_.defer_proofs();
    std::size_t collapses = passes_.sweep();
    if (!state_.prove_deferred()) {
      go_back(before, features);
      collapses = passes_.sweep();
    }
    tell("sweeps", collapses);
  }

  std::size_t move_into_place() {
    if (!state_.follows_shapes() || passes_.stopped()) return 0;
    std::size_t moved = 0, last = 1;
    for (int round = 0; round < kMostRoundsIntoPlace && last > 0 && !passes_.stopped(); ++round) {
      last = passes_.move_into_place();
      moved += last;
    }
    return tell("vertices moved onto planes", moved);
  }

  void move_toward_edges() {
    if (!passes_.has_true_edges()) return;
    const bool crowded = settings_.spread_on_planes && goes_on();
    std::size_t last = 1;
    for (int i = 0; i < kMostRoundsToEdges && last > 0 && !passes_.stopped(); ++i) {
      if (crowded && i < kRoundsWithRoom) {
        flip(kPowerForRoom);
        relocate(kPowerForRoom);
      }
      last = tell("vertices moved toward edges", passes_.move_toward_edges());
      last += move_into_place();
    }
  }

  // Only once the mesh is coarse: vertices as close as their noise would fold over each other.
  void settle_on_planes() {
    if (move_into_place() > 0) collapse();
  }

  // What other passes follow ends with fewer triangles where some room is left to them.
  void collapse() { tell("collapses", passes_.collapse(settings_.ends_with_collapses())); }

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

  // Between a mesh and a reference that is rough against the limit, an even error can mostly not be
  // reached, and one-sided it gains little; that is left to the deep effort. Features would leave
  // their place under loosened limits.
  bool may_even_out() const {
    if (!passes_.features().empty()) return false;
    if (state_.follows_shapes() && !settings_.spread_on_planes) return false;
    if (settings_.effort == Effort::kDeep) return true;
    return state_.back() != nullptr && state_.back()->is_smooth();
  }

  // Spreads the error evenly; with the deep effort as far as can be restored. Returns whether that
  // gained so much that nothing else needs to be tried; if not, the mesh is as before, and what was
  // gained is kept. Where the race is lost nothing else needs to be tried.
  bool equidistribute() {
    const DecimationState::Snapshot before = state_.snapshot();
    const FeatureEdges features = passes_.features();
    const double triangles = static_cast<double>(state_.mesh().triangles());
    const bool deep = settings_.effort == Effort::kDeep;
    std::vector<DecimationPasses::Place> stuck;
    bool within = deep && even_out(ErrorEquidistribution::kLong, stuck);
    // What could not be restored is left as it was, in another try.
    for (int i = 0; i < kSpreads && !within && !passes_.stopped() && !race_.lost(); ++i) {
      const std::size_t known = stuck.size();
      if (deep || i > 0) go_back(before, features);
      passes_.hold_around(stuck);
      within = even_out(ErrorEquidistribution::kShort, stuck);
      if (stuck.size() == known) break;
    }
    passes_.free();
    if (within && race_.lost()) return true;
    if (within) collapse_further(deep);
    if (within && static_cast<double>(state_.mesh().triangles()) < kMuch * triangles) return true;
    if (within) kept_ = state_.mesh().compact();
    go_back(before, features);
    return kept_ ? race_.lost() : lost(Race::At::kUneven);
  }

  bool even_out(const ErrorEquidistribution::Extent& extent,
                std::vector<DecimationPasses::Place>& stuck) {
    pass_share_ = kPassOfMany;
    ErrorEquidistribution even(state_, passes_, extent, race_,
                               [this](const char* pass, std::size_t edits) { tell(pass, edits); });
    const bool within = even.run();
    stuck.insert(stuck.end(), even.stuck().begin(), even.stuck().end());
    pass_share_ = kOtherPass;
    return within;
  }

  void go_back(const DecimationState::Snapshot& before, const FeatureEdges& features) {
    state_.restore(before);
    passes_.restart(features);
  }

  // Collapses that an even error leaves room for here and there: once, or with `deep` until nothing
  // is gained.
  void collapse_further(bool deep) {
    for (bool again = true; again && !passes_.stopped();) {
      state_.reassign();
      std::size_t gained = tell("mended collapses", passes_.collapse_and_mend());
      for (int round = 0; round < (deep ? 2 : 1); ++round) {
        flip(kHighPower);
        relocate(kHighPower);
      }
      gained += tell("collapses", passes_.collapse());
      again = deep && gained > 0;
    }
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
  Race race_;
  double begun_ = 0, weight_;  // shares of the work: done, and of the present pass
  double pass_share_ = kOtherPass;
  DecimationPasses passes_;
  std::optional<TriangleMesh> kept_;  // a mesh within its limits beside the present one
};

}  // namespace

ScheduledMesh run_passes(DecimationState& state, DecimationPasses::Options options,
                         const DecimationSettings& settings) {
  return Schedule(state, std::move(options), settings).run();
}

}  // namespace emax
