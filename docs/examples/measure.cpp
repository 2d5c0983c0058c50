// The error of a mesh against a cloud: the greatest distance, where it is, and how distances
// spread.
#include <emax/arithmetic.h>
#include <emax/measure.h>

#include <cmath>
#include <cstdio>

int main() {
  if (const auto fault = emax::probe_arithmetic()) {
    std::printf("this program cannot measure: %s\n", fault->c_str());
    return 1;
  }
  // 100 x 100 points on a wave, and two triangles below it.
  std::vector<double> cloud;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const double x = i / 99.0, y = j / 99.0;
      cloud.insert(cloud.end(), {x, y, 0.05 * std::sin(6 * x) * std::sin(5 * y)});
    }
  }
  const emax::Surface plane = {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 1, 2, 0, 2, 3}};

  emax::ErrorMeter meter(cloud);
  const emax::Measurement error = meter.e_max(plane);
  std::printf("e_max %.6f at point %zu, bits 0x%08x\n", error.e_max, error.worst_point,
              static_cast<unsigned>(error.squared_bits));
  std::printf("half of the points within %.6f\n", meter.quantile(plane, 0.5));
  std::printf("every distance is true to %.1e\n", meter.margin(plane, error.e_max));
}
