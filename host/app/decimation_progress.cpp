#include "host/app/decimation_progress.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/app/scan.h"

namespace emax {

double RisingShare::next(double guess) {
  constexpr double kSmallFall = 0.05;  // a smaller fall is only a better guess of the same work
  constexpr double kOfTheRest = 0.95;
  constexpr double kLast = 0.99;
  guess = std::clamp(guess, 0.0, kLast);
  began_again_ = guess < guess_ - kSmallFall;
  const auto share = [this] { return before_ + kOfTheRest * (1 - before_) * of_this_work(); };
  if (began_again_) {
    before_ = share();
    first_guess_ = guess;
  }
  guess_ = began_again_ ? guess : std::max(guess_, guess);
  return share();
}

double DecimationProgress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void DecimationProgress::begin(const char* phase, double seconds) {
  decimating_ = false;
  phase_.begin(phase, seconds);
}

void DecimationProgress::show(double share, std::size_t triangles) {
  if (!decimating_) begin("decimating", 0);
  decimating_ = true;
  phase_.advance(share_.next(share), fmt::format("{} triangles", grouped(triangles)));
}

}  // namespace emax
