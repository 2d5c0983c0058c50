#include "host/app/fit_report.h"

#include <fmt/format.h>

#include "host/app/scan.h"

namespace emax {

void print_fit(const ReferenceFit& fit, double epsilon) {
  if (fit.tried.empty()) return;
  fmt::print(
      "scan           points {:.3g} apart ({:.3g} of the tolerance), noise {:.2g} ({:.2g})\n",
      fit.scan.spacing, fit.scan.spacing / epsilon, fit.scan.noise, fit.scan.noise / epsilon);
  for (const TriedSurface& tried : fit.tried) {
    const bool taken = &tried == &fit.best();
    fmt::print("{:<14} {}: {}\n", taken ? "surface" : "not taken", tried.chain.method,
               tried.failure.empty() ? describe(tried) : tried.failure);
  }
  if (fit.surface.dropped_triangles + fit.surface.dropped_pieces + fit.surface.closed_cracks > 0) {
    fmt::print(
        "mended         {} cracks closed, {} needless pieces of {:.3g} area and {} triangles "
        "dropped\n",
        grouped(fit.surface.closed_cracks), grouped(fit.surface.dropped_pieces),
        fit.surface.dropped_area, grouped(fit.surface.dropped_triangles));
  }
  if (fit.joined + fit.left_out > 0) {
    fmt::print("far points     {} farther than {:.3g} joined to it, {} left out\n",
               grouped(fit.joined), fit.joined_beyond, grouped(fit.left_out));
  }
}

}  // namespace emax
