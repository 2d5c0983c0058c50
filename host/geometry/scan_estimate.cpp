#include "host/geometry/scan_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace emax {
namespace {

constexpr std::size_t kSampled = 20'000, kDensity = 10, kFitted = 25, kFew = 12, kCoefficients = 6;

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Standard deviation of the residuals of a quadric over the plane of principal components.
double residual(std::span<const Point> points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Point mean = Point::Zero();
  for (const Point& p : points) mean += p / static_cast<double>(n);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Point& p : points) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const double scale = std::sqrt(axes.eigenvalues()[2] / static_cast<double>(n));
  if (!(scale > 0)) return 0;
  Eigen::MatrixXd terms(n, static_cast<Eigen::Index>(kCoefficients));
  Eigen::VectorXd heights(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Point local =
        axes.eigenvectors().transpose() * (points[static_cast<std::size_t>(i)] - mean) / scale;
    const double x = local[2], y = local[1];
    terms.row(i) << 1, x, y, x * x, x * y, y * y;
    heights[i] = local[0];
  }
  const Eigen::VectorXd fit = terms.colPivHouseholderQr().solve(heights);
  const double squares = (terms * fit - heights).squaredNorm();
  return scale * std::sqrt(squares / static_cast<double>(points.size() - kCoefficients));
}

}  // namespace

ScanEstimate estimate_scan(std::span<const Point> cloud) {
  return cloud.size() < 3 ? ScanEstimate{} : estimate_scan(cloud, PointTree(cloud));
}

ScanEstimate estimate_scan(std::span<const Point> cloud, const PointTree& tree) {
  if (cloud.size() < 3) return {};
  const std::size_t step = (cloud.size() + kSampled - 1) / kSampled;
  std::vector<double> spacings, residuals, residuals_of_few;
  std::vector<PointTree::Neighbour> near;
  std::vector<Point> around;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    tree.nearest(cloud[i], kFitted, near);
    const std::size_t k = std::min(kDensity, near.size() - 1);
    spacings.push_back(
        std::sqrt(std::numbers::pi * near[k].squared_distance / static_cast<double>(k)));
    if (near.size() <= kCoefficients) continue;
    around.clear();
    for (const PointTree::Neighbour& n : near) around.push_back(cloud[n.index]);
    residuals.push_back(residual(around));
    residuals_of_few.push_back(residual(std::span(around).first(std::min(kFew, around.size()))));
  }
  // Medians of chi-squared over its degrees of freedom: 19 for 25 points and 6 for 12.
  const double all = std::pow(median(residuals), 2) / 0.9651;
  const double few = std::pow(median(residuals_of_few), 2) / 0.8914;
  constexpr double kRatio = double{kFitted} / double{kFew}, kGrowth = kRatio * kRatio * kRatio;
  const double variance = (kGrowth * few - all) / (kGrowth - 1);
  return {median(spacings), std::sqrt(std::clamp(variance, 0.0, all))};
}

std::optional<double> suggested_tolerance(const ScanEstimate& scan) {
  constexpr double kOfSpacing = 0.5, kOfNoise = 6;
  const double wanted = std::max(kOfSpacing * scan.spacing, kOfNoise * scan.noise);
  if (!(scan.spacing > 0) || !std::isfinite(wanted)) return std::nullopt;
  const double unit = std::pow(10, std::floor(std::log10(wanted)) - 1);
  return std::ceil(wanted / unit) * unit;
}

}  // namespace emax
