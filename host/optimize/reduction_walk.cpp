#include "host/optimize/reduction_walk.h"

#include <algorithm>

namespace emax {

std::optional<double> ReductionWalk::next() const {
  constexpr double kMargin = 0.2;   // a bracket always shrinks by a fifth at least
  constexpr double kWorth = 0.003;  // of the triangles: less than this in question is no trial
  if (trials_ == 0) return lower_;
  if (hopeless_ || trials_ == kMostTrials || !(upper_ > lower_)) return std::nullopt;
  if (violation_above_) {
    const double in_question =
        static_cast<double>(triangles_below_) - static_cast<double>(triangles_above_);
    if (in_question < kWorth * static_cast<double>(triangles_below_)) return std::nullopt;
    const double fall = *violation_above_ - *violation_below_;
    const double share = fall > 0 ? -*violation_below_ / fall : 0.5;
    return lower_ + std::clamp(share, kMargin, 1 - kMargin) * (upper_ - lower_);
  }
  // Nothing breaks the constraints yet: three quarters of the way to the end.
  return lower_ + 0.75 * (upper_ - lower_);
}

void ReductionWalk::told(bool evaluated_ok, std::size_t triangles, double violation) {
  const double value = *next();
  const bool first = trials_++ == 0;
  if (evaluated_ok && violation <= 0) {
    lower_ = value;
    violation_below_ = violation;
    triangles_below_ = triangles;
    return;
  }
  hopeless_ = first;
  upper_ = value;
  violation_above_ = evaluated_ok ? std::optional(violation) : std::nullopt;
  triangles_above_ = evaluated_ok ? triangles : 0;
}

}  // namespace emax
