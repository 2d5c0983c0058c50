#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "tests/support/scan_generator/scene.h"

namespace emax::test {

// A terrestrial laser scanner: rays on a grid of azimuth and elevation from each station, so that
// the density falls off with the square of the distance.
struct ScannerOptions {
  double points = 1e6;     // about so many from all stations together
  double noise = 0.002;    // metres, standard deviation of the range at 10 m, facing the beam
  double beam = 0.0005;    // radians: a beam that reaches over an edge by less meets both sides
  double dropouts = 0.01;  // share of the rays that do not come back, more where they graze
  double range = 120;      // metres
  std::uint64_t seed = 1;
  std::size_t threads = 1;
};

class Scanner {
 public:
  // The scene must outlive the scanner.
  Scanner(const Scene& scene, const ScannerOptions& options);
  ~Scanner();
  Scanner(const Scanner&) = delete;
  Scanner& operator=(const Scanner&) = delete;

  // Gives the points to `take` as they are scanned, station by station and column by column, some
  // thousands at a time. The same for any number of threads, and every time. Returns their number.
  std::uint64_t scan(const std::function<void(std::span<const Point>)>& take) const;

 private:
  struct Device;  // Embree's
  struct Hit {
    double range;   // infinite: none
    double facing;  // cosine of the angle between the beam and the normal
  };

  Hit cast(const Point& from, const Point& direction) const;
  // The points of one column of a station.
  std::vector<Point> column(std::size_t station, std::uint64_t column, double step) const;
  double step_for_points() const;

  const Scene& scene_;
  ScannerOptions options_;
  std::unique_ptr<Device> device_;
  double step_;  // radians between rays
};

}  // namespace emax::test
