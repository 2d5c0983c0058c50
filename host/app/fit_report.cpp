#include "host/app/fit_report.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "host/app/scan.h"

namespace emax {

void print_fit(Facts& facts, const ReferenceFit& fit, double epsilon) {
  if (fit.tried.empty()) return;
  facts.add("scan", "points {:.3g} apart ({:.3g} of the tolerance), noise {:.2g} ({:.2g})",
            fit.scan.spacing, fit.scan.spacing / epsilon, fit.scan.noise, fit.scan.noise / epsilon);
  for (const TriedSurface& tried : fit.tried) {
    const bool taken = &tried == &fit.best();
    facts.add(taken ? "surface" : "not taken", "{}: {}", tried.chain.method,
              tried.failure.empty() ? describe(tried) : tried.failure);
  }
  if (fit.made_of < fit.tried.front().points) {
    fmt::print("made of        {} points, evenly spread; measured by all\n", grouped(fit.made_of));
  }
  std::vector<std::string> mended;
  const auto say = [&](std::size_t count, const char* one, const char* many, const char* then) {
    if (count > 0) mended.push_back(grouped(count) + (count == 1 ? one : many) + then);
  };
  say(fit.surface.closed_cracks, " crack", " cracks", " closed");
  say(fit.surface.dropped_pieces, " piece", " pieces",
      fmt::format(" dropped that no point needs, {:.3g} in area", fit.surface.dropped_area)
          .c_str());
  say(fit.surface.dropped_triangles, " triangle", " triangles",
      " dropped that intersected others or were not manifold");
  if (!mended.empty()) facts.add("repaired", "{}", fmt::join(mended, ", "));
  if (fit.on_planes) print_on_planes(facts, *fit.on_planes);
  if (fit.joined + fit.left_out > 0) {
    facts.add("far points", "{} farther than {:.3g} joined to it, {} left out", grouped(fit.joined),
              fit.joined_beyond.with_others, grouped(fit.left_out));
  }
}

void print_on_planes(Facts& facts, const ClosedOnPlanes& made) {
  if (made.on_planes + made.own + made.wide == 0) return;
  facts.add("flat holes", "closed: {} on planes, {} others, area {:.4g}; {} wider on planes open",
            grouped(made.on_planes), grouped(made.own), made.area, grouped(made.wide));
}

void print_closed(Facts& facts, std::size_t holes, std::span<const OpenBorder> open) {
  facts.add("closed", "{} {} of the surface", grouped(holes), holes == 1 ? "hole" : "holes");
  for (const OpenBorder& border : open) {
    facts.add("left open", "a border of {} edges within {:.4g} of ({:.6g}, {:.6g}, {:.6g}): {}",
              grouped(border.edges), border.radius, border.middle.x(), border.middle.y(),
              border.middle.z(),
              border.edges > kMostClosedEdges
                  ? fmt::format("it has more than {} edges", grouped(kMostClosedEdges))
                  : "no patch continues the surface without intersecting it");
  }
}

}  // namespace emax
