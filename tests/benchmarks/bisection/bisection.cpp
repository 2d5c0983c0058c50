#include "tests/benchmarks/bisection/bisection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace emax::benchmarks {
namespace {

// How much coarser what is tried after the bisection is.
constexpr std::array kProbes = {0.004, 0.012, 0.03};

struct Outcome {
  double coarseness;
  std::size_t triangles;
  bool passes;
};

class Bisection {
 public:
  Bisection(const Attempt& attempt, const BisectionSettings& settings)
      : attempt_(attempt), settings_(settings) {
    found_.least_error = std::numeric_limits<double>::infinity();
  }

  Found run() {
    std::optional<Outcome> failed, passed;
    const double step = 1.0 / settings_.steps;
    for (int i = 0; !passed; ++i) {
      const double at = settings_.start - i * step;
      const Outcome outcome = call(std::max(0.0, at));
      if (outcome.passes) {
        passed = outcome;
      } else {
        failed = outcome;
        if (at < step / 1024 || beaten(outcome)) return found_;
      }
    }
    // It began below the coarsest.
    while (!failed && passed->coarseness < 1) {
      const Outcome outcome = call(std::min(1.0, passed->coarseness + step));
      (outcome.passes ? passed : failed) = outcome;
    }
    if (!failed) return found_;
    narrow(*passed, *failed);
    while (probe()) {
    }
    return found_;
  }

 private:
  Outcome call(double coarseness) {
    Trial trial = attempt_(coarseness);
    ++found_.calls;
    found_.seconds += trial.seconds;
    found_.least_error = std::min(found_.least_error, trial.error);
    const Outcome outcome{coarseness, trial.mesh.triangles.size(), trial.error <= settings_.limit};
    if (outcome.passes &&
        (!found_.best || outcome.triangles < found_.best->mesh.triangles.size())) {
      found_.best = std::move(trial);
      found_.coarseness = coarseness;
    }
    return outcome;
  }

  bool beaten(const Outcome& outcome) const {
    return settings_.beat && outcome.triangles >= *settings_.beat;
  }

  void narrow(Outcome passed, Outcome failed) {
    const auto close = [&] {
      const double difference =
          static_cast<double>(passed.triangles) - static_cast<double>(failed.triangles);
      return failed.coarseness - passed.coarseness <= settings_.width ||
             difference <= std::max(1.0, settings_.share * static_cast<double>(passed.triangles));
    };
    while (!close() && !beaten(failed)) {
      const Outcome outcome = call((passed.coarseness + failed.coarseness) / 2);
      (outcome.passes ? passed : failed) = outcome;
    }
  }

  // Whether it found fewer.
  bool probe() {
    const double from = found_.coarseness;
    if (beaten({from, found_.best->mesh.triangles.size(), true})) return false;
    std::optional<Outcome> passed, failed;
    for (const double coarser : kProbes) {
      if (from + coarser > 1) break;
      const Outcome outcome = call(from + coarser);
      if (outcome.passes) {
        passed = outcome;
        failed.reset();
      } else if (!failed) {
        failed = outcome;
      }
    }
    if (passed && failed) narrow(*passed, *failed);
    return found_.coarseness > from;
  }

  const Attempt& attempt_;
  const BisectionSettings& settings_;
  Found found_;
};

}  // namespace

double parameter_at(double coarseness, double finest, double coarsest) {
  return finest * std::pow(coarsest / finest, coarseness);
}

double coarseness_at(double parameter, double finest, double coarsest) {
  return std::clamp(std::log(parameter / finest) / std::log(coarsest / finest), 0.0, 1.0);
}

Found fewest_within(const Attempt& attempt, const BisectionSettings& settings) {
  return Bisection(attempt, settings).run();
}

}  // namespace emax::benchmarks
