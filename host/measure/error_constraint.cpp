#include "host/measure/error_constraint.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/block_search/simd_evaluator.h"
#include "host/measure/point_distances.h"
#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/error_bound.h"

namespace emax {

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
  return emax::in_file_units(cloud_, squared_bits);
}

std::optional<std::uint32_t> ErrorConstraint::threshold(MeshView mesh) const {
  const Normalization& normalization = cloud_.normalization();
  double longest = 0, farthest = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto corners = mesh.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).norm());
      farthest = std::max(farthest, (corners[k] - normalization.origin).norm());
    }
  }
  const double epsilon = normalization.length(epsilon_);
  const double reach = epsilon + 2 * normalization.length(longest) + normalization.length(farthest);
  return largest_feasible_bits(epsilon, reach);
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
  const std::optional<std::uint32_t> allowed = threshold(mesh);
  MeasuredError measured;
  if (excludable_ == 0) {
    measured.all = measured.kept = worst();
  } else {
    exclude(nearest(), allowed.value_or(0), measured);
  }
  measured.feasible = allowed && measured.kept.squared_bits <= *allowed;
  const double epsilon = cloud_.normalization().length(epsilon_);
  const double greatest = allowed ? std::max(distance_of(*allowed), epsilon / 1e3) : epsilon;
  const double excess = distance_of(measured.kept.squared_bits) / greatest - 1;
  measured.violation = measured.feasible ? std::min(excess, 0.0) : std::max(excess, 1e-12);
  return measured;
}

// Excludes the farthest points beyond `allowed`, up to the permitted number. Of equal distances the
// higher index is excluded first.
void ErrorConstraint::exclude(std::span<const std::uint32_t> bits, std::uint32_t allowed,
                              MeasuredError& measured) const {
  measured.all = worst_of(bits);
  std::vector<std::uint32_t> order(bits.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&bits](std::uint32_t a, std::uint32_t b) {
    return bits[a] != bits[b] ? bits[a] > bits[b] : a > b;
  });
  auto kept = order.begin();
  while (kept - order.begin() < static_cast<std::ptrdiff_t>(excludable_) && bits[*kept] > allowed) {
    ++kept;
  }
  measured.excluded.assign(order.begin(), kept);
  std::ranges::sort(measured.excluded);
  // Of the points with the same distance as the worst kept one, the last in the order has the
  // lowest index.
  auto worst = kept;
  while (worst + 1 != order.end() && bits[*(worst + 1)] == bits[*kept]) ++worst;
  measured.kept = {bits[*kept], *worst};
}

}  // namespace emax
