// A fine mesh made coarse: as few triangles as can be found with both surfaces within a bound.
#include <emax/decimate.h>

#include <cmath>
#include <cstdio>

// A square of n x n points, raised to a wave.
emax::Surface wave(unsigned n) {
  emax::Surface surface;
  for (unsigned i = 0; i < n; ++i) {
    for (unsigned j = 0; j < n; ++j) {
      const double x = i / (n - 1.0), y = j / (n - 1.0);
      surface.coordinates.insert(surface.coordinates.end(),
                                 {x, y, 0.1 * std::sin(6 * x) * std::sin(5 * y)});
      if (i == 0 || j == 0) continue;
      const unsigned c = i * n + j, b = c - 1, d = c - n, a = d - 1;
      surface.indices.insert(surface.indices.end(), {a, d, c, a, c, b});
    }
  }
  return surface;
}

int main() {
  const emax::Surface fine = wave(100);
  const emax::Decimation made = emax::decimate(fine, {.max_error = 0.002});
  std::printf("%zu triangles of %zu\n", made.surface.indices.size() / 3, fine.indices.size() / 3);
  std::printf("points within %.6f, surfaces within %.6f and %.6f\n", made.e_max, *made.to_reference,
              *made.from_reference);
}
