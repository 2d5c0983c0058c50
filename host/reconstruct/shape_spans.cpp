#include "host/reconstruct/shape_spans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "host/geometry/disjoint_sets.h"
#include "host/reconstruct/meeting_curves.h"
#include "host/reconstruct/sheet.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

using SheetEdge = std::pair<std::uint32_t, std::uint32_t>;

SheetEdge sheet_edge(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

// The surface of one sheet.
class SheetSurface {
 public:
  SheetSurface(const Sheet& sheet, std::vector<Point>& vertices)
      : sheet_(sheet), vertices_(vertices) {}

  std::vector<Triangle> run(std::span<const MeetingCurve* const> curves, double sagitta) {
    take_sites(curves);
    triangles_ = sheet_.triangulate(places_);
    if (!EMAX_FAULT(kSpansBeyondCurves)) keep_supported();
    if (sheet_.period() > 0) split_long_edges(sagitta);
    for (Triangle& t : triangles_) {
      for (std::uint32_t& corner : t) corner = sites_[corner];
    }
    return std::move(triangles_);
  }

 private:
  std::uint32_t add_site(std::uint32_t vertex, const Eigen::Vector2d& place) {
    sites_.push_back(vertex);
    places_.push_back(place);
    return static_cast<std::uint32_t>(sites_.size() - 1);
  }

  // Vertices of curves stand for the points that are near them. As no site is then in the circle
  // around an edge of a curve, all of these edges are in the triangulation.
  void take_sites(std::span<const MeetingCurve* const> curves) {
    std::map<std::uint32_t, std::uint32_t> site_of;
    for (const MeetingCurve* const curve : curves) {
      for (const std::vector<std::uint32_t>& chain : curve->chains) {
        for (std::size_t i = 0; i < chain.size(); ++i) {
          const auto [at, is_new] = site_of.try_emplace(chain[i], 0u);
          if (is_new) at->second = add_site(chain[i], sheet_.flatten(vertices_[chain[i]]));
          if (i > 0) curve_edges_.push_back(sheet_edge(site_of.at(chain[i - 1]), at->second));
        }
      }
    }
    std::ranges::sort(curve_edges_);
    first_point_ = static_cast<std::uint32_t>(sites_.size());
    for (const std::uint32_t i : sheet_.points()) {
      const bool is_at_curve = std::ranges::any_of(curves, [&](const MeetingCurve* curve) {
        return curve->is_near(vertices_[i], curve->step / 2);
      });
      if (!is_at_curve) add_site(i, sheet_.flatten(vertices_[i]));
    }
  }

  void keep_supported() {
    DisjointSets parts(triangles_.size());
    std::vector<std::pair<SheetEdge, std::uint32_t>> sides;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const SheetEdge edge = sheet_edge(triangles_[t][i], triangles_[t][(i + 1) % 3]);
        if (!std::ranges::binary_search(curve_edges_, edge)) sides.emplace_back(edge, t);
      }
    }
    std::ranges::sort(sides);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (sides[i].first == sides[i - 1].first) parts.join(sides[i].second, sides[i - 1].second);
    }
    std::vector<bool> supported(triangles_.size(), false);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (std::ranges::any_of(triangles_[t], [&](std::uint32_t i) { return i >= first_point_; })) {
        supported[parts.root(t)] = true;
      }
    }
    std::uint32_t t = 0;
    std::erase_if(triangles_, [&](const Triangle&) { return !supported[parts.root(t++)]; });
  }

  // Halves edges until none lies farther than this from the cylinder.
  void split_long_edges(double sagitta) {
    const double radius = sheet_.period() / (2 * std::numbers::pi);
    const double most = 2 * radius * std::acos(std::max(0.0, 1 - sagitta / radius));
    if (!(most > 0)) return;
    bool has_split = true;
    while (has_split) {
      has_split = false;
      std::map<SheetEdge, std::uint32_t> middles;
      std::vector<Triangle> halves;
      for (const Triangle& t : triangles_) {
        if (turn(t, 0) > most || turn(t, 1) > most || turn(t, 2) > most) {
          has_split = true;
          split(t, most, middles, halves);
        } else {
          halves.push_back(t);
        }
      }
      triangles_ = std::move(halves);
    }
  }

  // How far the edge from this corner to the next goes around the cylinder.
  double turn(const Triangle& t, std::size_t i) const {
    return std::abs(sheet_.around(places_[t[(i + 1) % 3]].x() - places_[t[i]].x()));
  }

  // Every edge that is too long gets a vertex in its middle, whichever triangles it has.
  void split(const Triangle& t, double most, std::map<SheetEdge, std::uint32_t>& middles,
             std::vector<Triangle>& halves) {
    std::vector<std::uint32_t> corners;  // and middles, in their order
    std::size_t first_middle = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      corners.push_back(t[i]);
      if (!(turn(t, i) > most)) continue;
      first_middle = corners.size();
      corners.push_back(middle_of(t[i], t[(i + 1) % 3], middles));
    }
    // A fan from a middle: no triangle of it has three places on one edge.
    const std::size_t n = corners.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      halves.push_back({corners[first_middle], corners[(first_middle + i) % n],
                        corners[(first_middle + i + 1) % n]});
    }
  }

  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b,
                          std::map<SheetEdge, std::uint32_t>& middles) {
    const auto [at, is_new] = middles.try_emplace(sheet_edge(a, b), 0u);
    if (is_new) {
      const Eigen::Vector2d &from = places_[at->first.first], to = places_[at->first.second];
      const Eigen::Vector2d place(from.x() + sheet_.around(to.x() - from.x()) / 2,
                                  (from.y() + to.y()) / 2);
      vertices_.push_back(sheet_.raise(place));
      at->second = add_site(static_cast<std::uint32_t>(vertices_.size() - 1), place);
    }
    return at->second;
  }

  const Sheet& sheet_;
  std::vector<Point>& vertices_;
  std::vector<std::uint32_t> sites_;  // their vertices
  std::vector<Eigen::Vector2d> places_;
  std::uint32_t first_point_ = 0;  // sites before it are of curves
  std::vector<SheetEdge> curve_edges_;
  std::vector<Triangle> triangles_;
};

}  // namespace

bool can_be_spanned(const Region& region) {
  if (!(region.area > 0) || region.may_be_curved) return false;
  if (std::holds_alternative<Sphere>(region.shape)) return false;
  if (std::holds_alternative<Plane>(region.shape)) return true;
  constexpr double kFewest = 1.5;
  const double spacing = std::sqrt(region.area / static_cast<double>(region.points.size()));
  return kFewest * spacing <= std::numbers::pi / 2 * std::get<Cylinder>(region.shape).radius;
}

ShapeSpans span_shapes(std::span<const Point> points, std::span<const Region> regions,
                       const SpanOptions& options) {
  ShapeSpans spans;
  std::vector<Point>& vertices = spans.mesh.vertices;
  vertices.assign(points.begin(), points.end());
  spans.owner.assign(points.size(), kNoRegion);
  std::vector<Sheet> sheets;
  for (std::uint32_t r = 0; r < regions.size(); ++r) {
    if (!can_be_spanned(regions[r])) continue;
    sheets.emplace_back(points, regions[r], options.reach);
    for (const std::uint32_t i : regions[r].points) {
      spans.owner[i] = r;
      vertices[i] = sheets.back().onto(points[i]);
    }
  }
  const std::vector<MeetingCurve> curves =
      meeting_curves(points, sheets, options.sagitta, vertices);
  for (std::uint32_t s = 0; s < sheets.size(); ++s) {
    std::vector<const MeetingCurve*> of_sheet;
    for (const MeetingCurve& curve : curves) {
      if (std::ranges::find(curve.sheets, s) != curve.sheets.end()) of_sheet.push_back(&curve);
    }
    const std::vector<Triangle> surface =
        SheetSurface(sheets[s], vertices).run(of_sheet, options.sagitta);
    spans.mesh.triangles.insert(spans.mesh.triangles.end(), surface.begin(), surface.end());
  }
  return spans;
}

}  // namespace emax
