#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hls/kernel/forms/three_edge.h"
#include "hls/kernel/reduce.h"
#include "host/engine/prepared_cloud.h"
#include "sw_model/certify/matrix_free.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/simd/emax_simd.h"
#include "tests/benchmarks/groups.h"
#include "tests/support/stimuli.h"

namespace emax::benchmarks {
namespace {

constexpr std::size_t kPoints = 1024, kTriangles = 64, kSlivers = 8;

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Corners = std::array<Vector<Scalar>, 3>;

// The same pairs in every representation, made beforehand.
struct Pairs {
  std::vector<Vector3<float>> points;
  std::vector<Vector<float>> eigen_points;
  std::vector<Vector<double>> double_points;
  PointArrays arrays;
  std::vector<TriangleRecord<float>> records;
  std::vector<BarycentricRecord<float>> barycentric_records;
  std::vector<Corners<float>> corners;
  std::vector<Corners<double>> double_corners;
};

Pairs make_pairs(bool neighbours) {
  const test::Stimulus s = test::bumpy_sphere(20, 30, kPoints, 81);
  const PreparedCloud cloud(s.cloud);
  Pairs pairs;
  for (const PointGroup& group : cloud.groups()) {
    for (const std::uint32_t i : group.points) pairs.points.push_back(cloud.points()[i]);
  }
  if (!neighbours) pairs.points.assign(cloud.points().begin(), cloud.points().end());
  for (const Vector3<float>& p : pairs.points) {
    pairs.eigen_points.emplace_back(p.x, p.y, p.z);
    pairs.double_points.push_back(pairs.eigen_points.back().cast<double>());
    pairs.arrays.push_back(p);
  }

  test::Random random(82);
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    std::array<Point, 3> corners = s.mesh().corners(i * s.triangles.size() / kTriangles);
    if (i % (kTriangles / kSlivers) == 0) {
      corners[2] = corners[0] + random.uniform(0, 1) * (corners[1] - corners[0]) +
                   1e-4 * random.point(-1, 1);
    }
    for (Point& corner : corners) corner = cloud.normalization().apply(corner);
    const TriangleFrame frame = make_frame(corners);
    pairs.records.push_back(make_record(frame, i));
    pairs.barycentric_records.push_back(make_barycentric_record(frame, i));
    pairs.double_corners.push_back(corners);
    pairs.corners.push_back(
        {corners[0].cast<float>(), corners[1].cast<float>(), corners[2].cast<float>()});
  }
  return pairs;
}

// One call a pair for every form, as the matrix-free ones are in a library of their own: nothing is
// vectorised over points and nothing of a triangle is kept between its points.
using Record = TriangleRecord<float>;
bool is_segment(const Record& t) { return (t.tag & kSegmentFlag) != 0; }

[[gnu::noipa]] float visible_edge(const Record& t, const Vector3<float>& p) {
  return squared_distance(t, is_segment(t), p);
}
[[gnu::noipa]] float three_edge(const Record& t, const Vector3<float>& p) {
  return squared_distance_three_edge(t, is_segment(t), p);
}
[[gnu::noipa]] float literal(const BarycentricRecord<float>& t, const Vector3<float>& p) {
  return squared_distance_barycentric(t, is_segment(t.frame), p);
}
template <class Scalar>
Scalar ericson(const Corners<Scalar>& t, const Vector<Scalar>& p) {
  return ericson_squared_distance(p, t[0], t[1], t[2]);
}
template <class Scalar>
Scalar eberly(const Corners<Scalar>& t, const Vector<Scalar>& p) {
  return eberly_squared_distance(p, t[0], t[1], t[2]);
}

template <class Scalar, auto kForm, class Triangle, class PointType>
auto pair_by_pair(const std::vector<Triangle>& triangles, const std::vector<PointType>& points) {
  return [&triangles, &points](benchmark::State& state) {
    std::vector<Scalar> nearest(points.size());
    for ([[maybe_unused]] const auto _ : state) {
      std::fill(nearest.begin(), nearest.end(), std::numeric_limits<Scalar>::infinity());
      for (const Triangle& triangle : triangles) {
        for (std::size_t i = 0; i < points.size(); ++i) {
          nearest[i] = std::min(nearest[i], kForm(triangle, points[i]));
        }
      }
      benchmark::DoNotOptimize(nearest.data());
      benchmark::ClobberMemory();
    }
  };
}

auto vectorised(const Pairs& pairs, const SimdTarget& target) {
  return [&pairs, target](benchmark::State& state) {
    std::vector<std::uint32_t> nearest(pairs.points.size());
    for ([[maybe_unused]] const auto _ : state) {
      std::fill(nearest.begin(), nearest.end(), kInfinityWord);
      target.update_nearest(pairs.arrays, pairs.records, nearest);
      benchmark::ClobberMemory();
    }
  };
}

void add_group(Groups& groups, const Pairs& pairs, const std::string& order) {
  Group& group = groups.emplace_back("One pair, points in " + order, "ns a pair", 1e9);
  constexpr double kPairs = kPoints * kTriangles;
  const auto& [points, eigen_points, double_points, arrays, records, barycentric, corners,
               double_corners] = pairs;
  group.add(kEricsonFloat, kPairs, pair_by_pair<float, ericson<float>>(corners, eigen_points));
  group.add("Ericson from the corners, double", kPairs,
            pair_by_pair<double, ericson<double>>(double_corners, double_points));
  group.add("Eberly from the corners, float", kPairs,
            pair_by_pair<float, eberly<float>>(corners, eigen_points));
  group.add("Eberly from the corners, double", kPairs,
            pair_by_pair<double, eberly<double>>(double_corners, double_points));
  group.add(kLiteral, kPairs, pair_by_pair<float, literal>(barycentric, points));
  group.add("three-edge form, float", kPairs, pair_by_pair<float, three_edge>(records, points));
  group.add(kVisibleEdge, kPairs, pair_by_pair<float, visible_edge>(records, points));
  for (const SimdTarget& target : simd_targets()) {
    group.add(simd_way(target.name()), kPairs, vectorised(pairs, target));
  }
}

}  // namespace

std::string simd_way(std::string_view target) {
  return fmt::format("visible-edge form, SIMD target {}", target);
}

void add_pair_groups(Groups& groups) {
  static const Pairs at_random = make_pairs(false), neighbours = make_pairs(true);
  add_group(groups, at_random, "random order");
  groups.back().describe(fmt::format(
      "{} points by {} triangles of a bumpy sphere, {} of them slivers. The matrix-free ways start "
      "from the corners, the others from a record that is made of each triangle beforehand. Each "
      "pair is one call, so that the choices between edges become branches. With a SIMD target the "
      "kernel's source is vectorised over points instead, without branches.",
      kPoints, kTriangles, kSlivers));
  add_group(groups, neighbours, "order of neighbourhood");
  groups.back().describe(
      "The same pairs as above. Points that follow each other mostly take the same branches.");
}

}  // namespace emax::benchmarks
