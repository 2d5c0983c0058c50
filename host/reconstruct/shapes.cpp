// Planes and cylinders of the scan as surfaces, and greedy projection triangulation of the rest.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "host/features/find_features.h"
#include "host/geometry/disjoint_sets.h"
#include "host/geometry/edge_sides.h"
#include "host/parameters/registry.h"
#include "host/reconstruct/greedy_projection.h"
#include "host/reconstruct/local_cloud.h"
#include "host/reconstruct/reconstruction.h"
#include "host/reconstruct/shape_spans.h"
#include "host/reconstruct/sheet.h"
#include "host/surface/manifold_part.h"
#include "host/surface/mesh_orientation.h"

namespace emax {
namespace {

constexpr double kLeastBand = 0.05;  // of the spacing, where a scan has no noise

// Gives a region the points that no region has which lie within the band of its shape and are
// connected with its own points as those are with each other. Where a scanner sees a surface from
// the side, its points lie in rows, and tell nothing of how it is turned.
void adopt(Region& region, std::span<const Point> points, double band, double reach,
           std::vector<bool>& is_owned) {
  const Sheet sheet(points, region, reach);
  std::vector<std::uint32_t> members = region.points;
  const std::size_t own = members.size();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!is_owned[i] && distance(region.shape, points[i]) <= band) members.push_back(i);
  }
  if (members.size() == own) return;
  std::vector<Eigen::Vector2d> places;
  for (const std::uint32_t i : members) places.push_back(sheet.flatten(points[i]));
  DisjointSets connected(members.size());
  for (const Triangle& t : sheet.triangulate(places)) {
    connected.join(t[0], t[1]);
    connected.join(t[0], t[2]);
  }
  std::vector<bool> has_own(members.size(), false);
  for (std::size_t m = 0; m < own; ++m) has_own[connected.root(m)] = true;
  for (std::size_t m = own; m < members.size(); ++m) {
    if (!has_own[connected.root(m)]) continue;
    region.points.push_back(members[m]);
    is_owned[members[m]] = true;
  }
  std::ranges::sort(region.points);
}

void adopt_points(Features& features, std::span<const Point> points, double reach) {
  std::vector<bool> is_owned(points.size(), false);
  for (const Region& region : features.regions) {
    for (const std::uint32_t i : region.points) is_owned[i] = true;
  }
  for (Region& region : features.regions) {
    if (can_be_spanned(region)) adopt(region, points, features.options.band, reach, is_owned);
  }
}

// The points that no shape has, but for those that are noise of one: no farther from it than twice
// what its points may be, nor from the nearest of these than it spans.
std::vector<std::uint32_t> rest_of(std::span<const Point> points, const Features& features,
                                   std::span<const std::uint32_t> owner, double reach) {
  std::vector<Point> owned;
  std::vector<std::uint32_t> owner_of;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (owner[i] == kNoRegion) continue;
    owned.push_back(points[i]);
    owner_of.push_back(owner[i]);
  }
  const PointTree tree(owned);
  std::vector<PointTree::Neighbour> nearest;
  const auto is_noise = [&](const Point& p) {
    tree.nearest(p, 1, nearest);
    if (nearest.empty()) return false;
    const Region& region = features.regions[owner_of[nearest[0].index]];
    const double spanned =
        reach * std::sqrt(region.area / static_cast<double>(region.points.size()));
    return nearest[0].squared_distance <= spanned * spanned &&
           distance(region.shape, p) <= 2 * features.options.band;
  };
  std::vector<std::uint32_t> rest;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (owner[i] == kNoRegion && !is_noise(points[i])) rest.push_back(i);
  }
  return rest;
}

// The points at the borders of the spans that are points of the cloud.
std::vector<std::uint32_t> border_points(const ShapeSpans& spans) {
  std::vector<std::uint32_t> at_border;
  EdgeSides(spans.mesh.view()).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() != 1) return;
    at_border.push_back(sides[0].upper);
    const std::size_t corner = sides[0].lower_corner;
    at_border.push_back(spans.mesh.triangles[corner / 3][corner % 3]);
  });
  std::ranges::sort(at_border);
  at_border.erase(std::ranges::unique(at_border).begin(), at_border.end());
  std::erase_if(at_border, [&](std::uint32_t i) { return i >= spans.owner.size(); });
  return at_border;
}

// The rest's triangles among each other and with the borders of the spans, but for those with an
// edge longer than `longest`: a few points far from all others would be joined across open space.
void add_rest(ShapeSpans& spans, std::vector<std::uint32_t> rest, const LocalCloud& cloud,
              std::span<const Eigen::Vector3f> normals, const ParameterValues& values,
              double longest) {
  if (rest.empty()) return;
  std::vector<bool> is_rest(cloud.size(), false);
  for (const std::uint32_t i : rest) is_rest[i] = true;
  std::ranges::copy(border_points(spans), std::back_inserter(rest));
  if (rest.size() < 3) return;
  std::ranges::sort(rest);
  std::vector<Point> points;
  std::vector<Eigen::Vector3f> their_normals;
  for (const std::uint32_t i : rest) {
    points.push_back(cloud.original(i));
    their_normals.push_back(normals[i]);
  }
  const TriangleMesh more =
      greedy_projection(LocalCloud(points, cloud.normalization()), their_normals, values);
  for (const Triangle& t : more.triangles) {
    const auto is_long = [&](std::size_t i) {
      return (more.vertices[t[i]] - more.vertices[t[(i + 1) % 3]]).norm() > longest;
    };
    if (is_long(0) || is_long(1) || is_long(2)) continue;
    const Triangle in_cloud = {rest[t[0]], rest[t[1]], rest[t[2]]};
    if (std::ranges::any_of(in_cloud, [&](std::uint32_t i) { return is_rest[i]; })) {
      spans.mesh.triangles.push_back(in_cloud);
    }
  }
}

}  // namespace

Reconstruction Shapes::run(const LocalCloud& cloud, const ParameterValues& values,
                           std::size_t threads) {
  std::vector<Point> points(cloud.size());  // around the origin
  const Point origin = cloud.world(Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = cloud.original(i) - origin;
  const ScanEstimate scan = estimate_scan(points);
  FeatureSearch search;
  search.max_error = std::max(values.at(kBand) * scan.noise, kLeastBand * scan.spacing);
  search.least_support = static_cast<std::size_t>(values.at(kLeastPoints));
  search.threads = threads;
  Features features = find_features(points, search);
  const double reach = values.at(kReach);
  adopt_points(features, points, reach);
  ShapeSpans spans =
      span_shapes(points, features.regions, {.reach = reach, .sagitta = features.options.band});
  std::vector<Eigen::Vector3f> normals = cloud.oriented_normals(values, threads).normals;
  std::vector<std::uint32_t> rest = rest_of(points, features, spans.owner, reach);
  add_rest(spans, std::move(rest), cloud, normals, values, reach * scan.spacing);

  Reconstruction result;
  std::vector<bool> meshed(spans.mesh.vertices.size(), false);
  for (const Triangle& t : spans.mesh.triangles) {
    for (const std::uint32_t corner : t) meshed[corner] = true;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!meshed[i] && spans.owner[i] == kNoRegion) result.unmeshed_points += cloud.multiplicity(i);
  }
  normals.resize(spans.mesh.vertices.size(), Eigen::Vector3f::Zero());
  orient_consistently(spans.mesh, normals);
  for (Point& vertex : spans.mesh.vertices) vertex += origin;
  drop_unused(spans.mesh);
  result.mesh = cut_to_manifold(std::move(spans.mesh)).mesh;
  return result;
}

}  // namespace emax
