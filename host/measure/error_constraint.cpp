#include "host/measure/error_constraint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/block_search/simd_evaluator.h"
#include "host/measure/point_distances.h"
#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/error_bound.h"

namespace emax {
namespace {

// The greatest kernel e_max^2 that proves epsilon; nothing if even 0 does not, because epsilon is
// below the kernel's own error.
std::optional<std::uint32_t> threshold(const MeshExtent& mesh, const Normalization& normalization,
                                       double epsilon) {
  const double limit = normalization.length(epsilon);
  const double reach =
      limit + 2 * normalization.length(mesh.longest_edge) + normalization.length(mesh.farthest);
  return largest_feasible_bits(limit, reach);
}

}  // namespace

MeasuredError judge(const MeshExtent& mesh, const Normalization& normalization, double epsilon,
                    const FarthestPoints& points) {
  const std::optional<std::uint32_t> allowed = threshold(mesh, normalization, epsilon);
  FarthestPoints::Excluded found = points.exclude(allowed.value_or(0));
  MeasuredError measured;
  measured.kept = found.kept;
  measured.all = found.all;
  measured.excluded = std::move(found.excluded);
  measured.feasible = allowed && measured.kept.squared_bits <= *allowed;
  const double limit = normalization.length(epsilon);
  const double greatest = allowed ? std::max(distance_of(*allowed), limit / 1e3) : limit;
  const double excess = distance_of(measured.kept.squared_bits) / greatest - 1;
  measured.violation = measured.feasible ? std::min(excess, 0.0) : std::max(excess, 1e-12);
  return measured;
}

std::size_t excludable_points(double share, std::size_t points) {
  constexpr double kRoundings = 1 + 1e-12;
  return static_cast<std::size_t>(share * static_cast<double>(points) * kRoundings);
}

ErrorConstraint::ErrorConstraint(std::span<const Point> cloud, double epsilon,
                                 double excluded_share, bool brute_force, std::size_t threads)
    : cloud_(cloud),
      engine_(cloud_, {.threads = threads}),
      epsilon_(epsilon),
      excludable_(excludable_points(excluded_share, cloud.size())),
      brute_force_(brute_force),
      threads_(threads) {}

double ErrorConstraint::in_file_units(std::uint32_t squared_bits) const {
  return emax::in_file_units(cloud_.normalization(), squared_bits);
}

double ErrorConstraint::provable_distance() const {
  const double epsilon = cloud_.normalization().length(epsilon_);
  // In normalised units the cloud's box is within [-1, 1]^3.
  const double corner = std::sqrt(3.0) * (1 + epsilon);
  const std::optional<std::uint32_t> bits =
      largest_feasible_bits(epsilon, epsilon + 2 * 2 * corner + corner);
  if (!bits || *bits == 0) {
    throw Error("the tolerance is below what the kernel can tell apart; raise --max-error");
  }
  return in_file_units(*bits);
}

MeasuredError ErrorConstraint::measure(MeshView mesh, const std::function<bool()>& interrupted) {
  return measure(mesh, prepare(mesh), interrupted);
}

MeasuredError ErrorConstraint::measure(MeshView mesh, const PreparedMesh& prepared,
                                       const std::function<bool()>& interrupted) {
  if (brute_force_) {
    SimdEvaluator every_pair;
    return measure(mesh, every_pair, {.interrupted = interrupted});
  }
  engine_.interrupt_with(interrupted);
  return judge(
      mesh, [&] { return engine_.e_max(prepared); },
      [&] { return engine_.squared_distances(prepared); });
}

PreparedMesh ErrorConstraint::prepare(MeshView mesh) const {
  return PreparedMesh(mesh, cloud_.normalization(), engine_.target(), threads_);
}

std::vector<double> ErrorConstraint::distances(const PreparedMesh& prepared,
                                               const std::function<bool()>& interrupted) {
  engine_.interrupt_with(interrupted);
  return point_distances(cloud_, engine_, prepared);
}

MeasuredError ErrorConstraint::measure(MeshView mesh, Evaluator& device,
                                       const SearchOptions& options) const {
  const TriangleTree tree(mesh, cloud_.normalization());
  const auto emax = brute_force_ ? brute_force_emax : search_emax;
  const auto nearest = brute_force_ ? brute_force_nearest : search_nearest;
  return judge(
      mesh, [&] { return emax(cloud_, tree, device, options); },
      [&] { return nearest(cloud_, tree, device, options); });
}

MeasuredError ErrorConstraint::judge(
    MeshView mesh, const std::function<EmaxResult()>& worst,
    const std::function<std::vector<std::uint32_t>()>& nearest) const {
  FarthestPoints points(excludable_);
  if (excludable_ == 0) {
    points.add(worst());
  } else {
    points.add(nearest(), {});
  }
  const MeshExtent extent(mesh, cloud_.normalization());
  return emax::judge(extent, cloud_.normalization(), epsilon_, points);
}

}  // namespace emax
