#include "host/decimate/bounded_decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include "host/decimate/decimation_schedule.h"
#include "host/decimate/far_points.h"
#include "host/decimate/spatial_order.h"
#include "host/geometry/bounds.h"
#include "host/surface/manifold_part.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// Roundings of the local tests: a few units in the last place of the coordinates.
constexpr double kRelativeRoundings = 0x1p-46;
constexpr double kMargin = 1e-7;
// Of the extent: twice what surface_distance leaves undecided, so that the certificate of a mesh
// that comes as near to its limit as it may does not fail.
constexpr double kUndecided = 0x1p-29, kMostUndecided = 0.01;  // and at most of the limit
constexpr double kBelongs = 0.1;                               // of the mesh's width
// Times the limit: longer edges of the reference get a sample, those of its border several.
constexpr double kSampledEdge = 4, kSampledBorder = 1;
constexpr double kMostOnBorder = 7;
constexpr double kOnPlane = 1e-7;  // of the limit: what lies on a plane but for rounding
constexpr double kEdgeReach = 3;   // of the limit: to the mesh's edge that stands for a true one

double greatest_coordinate(std::initializer_list<std::span<const Point>> sets) {
  double greatest = 0;
  for (const std::span<const Point> points : sets) {
    for (const Point& p : points) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  }
  return greatest;
}

double limit_of(double epsilon, double roundings, double undecided) {
  if (!(epsilon > 0) || !std::isfinite(epsilon)) {
    throw Error("the maximum error of a decimation has to be positive and finite");
  }
  if (epsilon < 1e3 * roundings) {
    throw Error(
        "the maximum error is lost in the roundings of the coordinates; move the data "
        "closer to the origin or allow more");
  }
  return epsilon * (1 - kMargin) - roundings - std::min(undecided, kMostUndecided * epsilon);
}

// One point in so many guides the search: about as many as the reference has vertices, and never
// few.
std::size_t guides_of(std::size_t points, std::size_t vertices) {
  constexpr std::size_t kGuides = 160'000;
  return std::max<std::size_t>(points / std::max(vertices, kGuides), 1);
}

bool has_planes(const DecimationSettings& settings) {
  return settings.planes && !settings.planes->empty();
}

// The triangles on each shape follow each other, in the order of the shapes; then all others.
void order_by_shape(TriangleMesh& mesh, std::span<const Shape> shapes, double limit) {
  const std::vector<std::uint32_t> shape_of =
      shapes_under(mesh, shapes, kOnPlane * limit, kBesideShape * limit);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t t) { return shape_of[t]; });
  std::vector<Triangle> ordered;
  for (const std::uint32_t t : order) ordered.push_back(mesh.triangles[t]);
  mesh.triangles = std::move(ordered);
}

// As far apart as the limit. A surface that is rough against the limit turns anywhere.
std::vector<Point> true_edges_of(const TriangleMesh& start, const DecimationState& state) {
  std::vector<std::uint32_t> shape_of(start.triangles.size());
  for (std::uint32_t t = 0; t < shape_of.size(); ++t) shape_of[t] = state.shape_of(t);
  const double limit = std::sqrt(state.squared_limit());
  const bool smooth = state.back() != nullptr && state.back()->is_smooth();
  return sample_true_edges(start, state.shapes(), shape_of, smooth, limit);
}

void require_belonging(const DecimationState& state) {
  const AssignedPoints& assigned = state.assigned();
  std::size_t away = 0;
  for (std::uint32_t p = 0; p < assigned.size(); ++p) {
    if (assigned.owner(p) == kNoIndex) ++away;
  }
  if (2 * away > assigned.size()) {
    throw Error(
        "the cloud does not belong to the mesh: " + std::to_string(away) + " of " +
        std::to_string(assigned.size()) +
        " points are farther from it than a tenth of its width; give the mesh's own cloud, in "
        "its unit");
  }
}

}  // namespace

DataExtent extent_of(const TriangleMesh& reference, const TriangleMesh& start,
                     std::span<const Point> cloud) {
  return {bounds_of(reference.vertices).width(),
          greatest_coordinate({start.vertices, reference.vertices, cloud})};
}

ReferenceSurface reference_surface(const TriangleMesh& mesh, std::span<const Point> cloud,
                                   const JoiningDistance& far,
                                   const std::function<bool()>& interrupted, MadeManifold how,
                                   std::size_t threads) {
  if (cloud.empty()) throw Error("there is no point to keep a mesh close to; give a cloud");
  ReferenceSurface surface;
  if (how == MadeManifold::kByDropping) {
    ManifoldPart part = manifold_part(mesh);
    surface.mesh = std::move(part.mesh);
    surface.dropped = part.dropped;
  } else {
    CutSurface cut = cut_to_manifold(mesh);
    surface = {std::move(cut.mesh), cut.merged,       cut.turned, cut.dropped, cut.split,
               cut.cut_edges,       cut.cut_vertices, 0,          {}};
  }
  if (surface.mesh.triangles.empty()) {
    throw Error("the mesh has no triangle of any area that could be decimated; reconstruct first");
  }
  const double reach = std::max(far.alone, kBelongs * bounds_of(surface.mesh.vertices).width());
  DecimationState::Guards guards;
  guards.threads = threads;
  DecimationState state(surface.mesh, cloud, nullptr, reach * reach, guards, interrupted);
  if (!state.complete()) return surface;
  require_belonging(state);
  FarPoints inserted = insert_far_points(state, far, interrupted);
  surface.mesh = std::move(inserted.mesh);
  surface.inserted = inserted.inserted;
  surface.left_out = std::move(inserted.left_out);
  return surface;
}

// The part that runs have in common: the points along a curve, the reference between them and its
// trees.
struct BoundedDecimator::Prepared {
  std::vector<std::uint32_t> order;  // of the cloud's points, then of the reference's own
  std::vector<Point> points;         // in that order
  std::vector<Triangle> triangles;   // of the reference, between these points
  double covered = 0;                // the limit that samples of the reference were made for
  std::unique_ptr<BackBound> back;
};

namespace {

using Place = std::array<double, 3>;

// The vertices of the reference as points: a point of the cloud where it has one at the same place,
// else a new point after the cloud's.
std::vector<std::uint32_t> as_points(const TriangleMesh& reference, std::vector<Point>& points) {
  std::vector<std::pair<Place, std::uint32_t>> places;
  places.reserve(points.size());
  const auto at = [](const Point& p) { return Place{p[0], p[1], p[2]}; };
  for (std::uint32_t i = 0; i < points.size(); ++i) places.emplace_back(at(points[i]), i);
  std::ranges::sort(places);
  std::vector<std::uint32_t> point_of;
  for (const Point& v : reference.vertices) {
    const auto found = std::ranges::lower_bound(places, std::pair{at(v), 0u});
    const bool known = found != places.end() && found->first == at(v);
    point_of.push_back(known ? found->second : static_cast<std::uint32_t>(points.size()));
    if (!known) points.push_back(v);
  }
  return point_of;
}

// With the vertices that they have.
TriangleMesh first_triangles(const TriangleMesh& mesh, std::size_t count) {
  TriangleMesh part;
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNoIndex);
  for (std::size_t t = 0; t < count; ++t) {
    Triangle& triangle = part.triangles.emplace_back(mesh.triangles[t]);
    for (std::uint32_t& v : triangle) {
      if (number[v] == kNoIndex) {
        number[v] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
  }
  return part;
}

// Of all triangles, from their corners to the next ones; sorted.
std::vector<std::array<std::uint32_t, 2>> directed_edges(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  }
  std::ranges::sort(edges);
  return edges;
}

// Adds the middles of the reference's edges that are much longer than the limit. Without them a
// coarse reference has no points between its vertices that show the error. Along borders they lie
// as close as the limit: there the mesh ends, so that a corner of its border, drawn inwards, leaves
// the middle of an edge uncovered that has both ends near the mesh.
void add_samples(const TriangleMesh& reference, double limit, std::vector<Point>& points) {
  const std::vector<std::array<std::uint32_t, 2>> edges = directed_edges(reference);
  for (const auto& [from, to] : edges) {
    const Point &a = reference.vertices[from], &b = reference.vertices[to];
    const double length = (b - a).norm() / limit;
    if (!(length > kSampledBorder)) continue;
    const bool border = !std::ranges::binary_search(edges, std::array{to, from});
    if (!border && (length <= kSampledEdge || from > to)) continue;
    const double most = border ? kMostOnBorder : 1;
    const double count = std::clamp(std::ceil(length / kSampledBorder) - 1, 1.0, most);
    for (int i = 1; i <= static_cast<int>(count); ++i)
      points.push_back(a + i / (count + 1) * (b - a));
  }
}

}  // namespace

const BoundedDecimator::Prepared& BoundedDecimator::prepared(double limit,
                                                             double back_limit) const {
  if (prepared_ == nullptr) prepared_ = std::make_shared<Prepared>();
  Prepared& made = *prepared_;
  // Under a two-sided bound the vertices of the reference also count as points.
  const double covered = back_limit > 0 ? limit : 0;
  if (made.points.empty() || made.covered != covered) {
    made.covered = covered;
    std::vector<Point> all(cloud_.begin(), cloud_.end());
    TriangleMesh part;  // of the reference, where not all of it is to be covered
    if (covered_ < reference_.triangles.size()) part = first_triangles(reference_, covered_);
    const TriangleMesh& near = part.triangles.empty() ? reference_ : part;
    std::vector<std::uint32_t> point_of;
    if (covered > 0) {
      point_of = as_points(near, all);
      add_samples(near, limit, all);
    }
    made.order = spatial_order(all);
    made.points.clear();
    std::vector<std::uint32_t> place_of(all.size());
    for (const std::uint32_t p : made.order) {
      place_of[p] = static_cast<std::uint32_t>(made.points.size());
      made.points.push_back(all[p]);
    }
    made.triangles.clear();
    if (covered > 0) {
      for (const Triangle& t : near.triangles) {
        made.triangles.push_back(
            {place_of[point_of[t[0]]], place_of[point_of[t[1]]], place_of[point_of[t[2]]]});
      }
    }
  }
  if (back_limit > 0) {
    if (prepared_->back == nullptr) {
      prepared_->back = std::make_unique<BackBound>(reference_, back_limit);
    }
    prepared_->back->set_limit(back_limit);
  }
  return *prepared_;
}

DecimatedMesh BoundedDecimator::run(const TriangleMesh& start,
                                    const DecimationSettings& settings) const {
  const bool twice = settings.without_planes_too && has_planes(settings);
  return twice ? run_twice(start, settings) : run(start, settings, 0);
}

// With planes, then without.
DecimatedMesh BoundedDecimator::run_twice(const TriangleMesh& start,
                                          const DecimationSettings& settings) const {
  DecimationSettings half = settings;
  half.spread_on_planes = true;
  double begun = 0;
  if (settings.advanced) {
    half.advanced = [&](double share, std::size_t triangles) {
      settings.advanced(begun + share / 2, triangles);
    };
  }
  DecimatedMesh with = run(start, half, 0);
  if (with.interrupted) return with;
  begun = 0.5;
  half.planes = nullptr;
  if (with.expected == 0) half.rival = with.mesh.triangles.size();
  DecimatedMesh without = run(start, half, 0);
  const bool fewer = without.mesh.triangles.size() < with.mesh.triangles.size();
  with.interrupted = without.interrupted;
  return fewer ? without : with;
}

DecimatedMesh BoundedDecimator::run(const TriangleMesh& start, const DecimationSettings& settings,
                                    double reach) const {
  if (start.triangles.empty()) throw Error("the mesh has no triangles to decimate");
  const DataExtent extent =
      settings.extent.width > 0 ? settings.extent : extent_of(reference_, start, cloud_);
  const double roundings = kRelativeRoundings * extent.greatest;
  const double undecided = kUndecided * extent.width;
  const double limit = limit_of(settings.epsilon, roundings, undecided);
  double back_limit = 0;
  if (settings.two_sided) {
    const bool own = settings.epsilon_back > 0;
    back_limit = limit_of(own ? settings.epsilon_back : settings.epsilon, roundings, undecided);
  }
  const Prepared& known = prepared(limit, back_limit);
  DecimationState::Guards guards;
  guards.normal_cosine = settings.normal_cosine;
  guards.flatness = settings.flatness;
  guards.squared_reach = reach * reach;
  guards.threads = settings.threads;
  guards.recalls = settings.ends_with_collapses();
  const bool hoppe = settings.objective == DecimationSettings::Objective::kHoppe;
  if (!hoppe) guards.guides = guides_of(cloud_.size(), reference_.vertices.size());
  const TriangleMesh ordered = spatially_ordered(start);
  DecimationState state(ordered, known.points, settings.two_sided ? known.back.get() : nullptr,
                        limit * limit, guards, settings.interrupted, known.triangles);
  if (!state.complete()) return {start, {}, true, 0};

  DecimatedMesh result;
  for (std::uint32_t p = 0; p < known.points.size(); ++p) {
    if (known.order[p] >= cloud_.size()) continue;
    if (state.assigned().owner(p) == kNoIndex) result.left_out.push_back(known.order[p]);
  }
  std::ranges::sort(result.left_out);
  DecimationPasses::Options options;
  options.fixed_places = settings.fixed;
  if (settings.feature_angle > 0) options.features = FeatureEdges(ordered, settings.feature_angle);
  if (hoppe) {
    const double width = bounds_of(reference_.vertices).width();
    options.spring = settings.hoppe.spring;
    options.representation = settings.hoppe.representation * width * width / (limit * limit);
  }
  if (has_planes(settings)) {
    state.follow(settings.planes->shapes(),
                 planes_of_triangles(ordered, *settings.planes, limit, settings.threads));
    options.true_edges = TrueEdges(true_edges_of(ordered, state), kEdgeReach * limit);
  }
  ScheduledMesh scheduled = run_passes(state, std::move(options), settings);
  result.interrupted = !scheduled.complete;
  result.expected = scheduled.expected;
  result.mesh = std::move(scheduled.mesh);
  if (has_planes(settings)) order_by_shape(result.mesh, settings.planes->shapes(), limit);
  return result;
}

}  // namespace emax
