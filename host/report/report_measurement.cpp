#include "host/report/report_measurement.h"

#include <algorithm>
#include <cmath>

#include "host/geometry/bounds.h"
#include "host/picture/deviation_picture.h"

namespace emax {
namespace {

// In a page the picture takes the place of a view that cannot be shown.
constexpr PictureSize kPagePicture{640, 480}, kPicture{1600, 1200};

class Measurement {
 public:
  Measurement(const PointCloud& cloud, MeshView mesh, const std::vector<std::uint32_t>& excluded,
              std::optional<double> epsilon, const ReportWishes& wishes, std::size_t threads)
      : cloud_(cloud),
        mesh_(mesh),
        excluded_(excluded),
        epsilon_(epsilon),
        wishes_(wishes),
        threads_(threads),
        deviations_(deviations_of(cloud.points, mesh, excluded, threads)) {}

  ReportMeasurement take() {
    ReportMeasurement m;
    m.is_signed = deviations_.are_signed;
    m.left_out = cloud_.left_out;
    const std::vector<std::uint32_t> kept = kept_points();
    std::vector<double> of_kept;
    for (const std::uint32_t i : kept) of_kept.push_back(deviations_.of_points[i]);
    m.statistics = deviation_statistics(of_kept, epsilon_);
    const double reach = reach_of(m.statistics);
    m.histogram = deviation_histogram(of_kept, m.is_signed, reach);
    const std::vector<std::uint32_t> worst = farthest(kept, kWorstShown);
    m.worst = described(worst);
    m.excluded = described(farthest(excluded_, kMostExcludedShown));
    m.excluded_count = excluded_.size();
    const std::vector<std::uint32_t> shown = points_shown(cloud_.points, excluded_, worst);
    m.geometry = report_geometry(cloud_.points, shown, mesh_, deviations_, reach);
    m.geometry.points_of = kept.size();
    draw(shown, reach, m);
    return m;
  }

 private:
  std::vector<std::uint32_t> kept_points() const {
    std::vector<bool> is_excluded(cloud_.points.size(), false);
    for (const std::uint32_t i : excluded_) is_excluded[i] = true;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < is_excluded.size(); ++i) {
      if (!is_excluded[i]) kept.push_back(i);
    }
    return kept;
  }

  // A mesh that meets every point still has a legend, of a length that is nothing beside the mesh.
  double reach_of(const DeviationStatistics& s) const {
    if (epsilon_) return *epsilon_;
    const double greatest = std::max(std::abs(s.min), std::abs(s.max));
    return std::max(greatest, 1e-12 * bounds_of(cloud_.points).width());
  }

  std::vector<std::uint32_t> farthest(std::vector<std::uint32_t> points, std::size_t most) const {
    const auto farther = [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = std::abs(deviations_.of_points[a]);
      const double at_b = std::abs(deviations_.of_points[b]);
      return at_a != at_b ? at_a > at_b : a < b;
    };
    const std::size_t count = std::min(most, points.size());
    std::ranges::partial_sort(points, points.begin() + static_cast<std::ptrdiff_t>(count), farther);
    points.resize(count);
    return points;
  }

  std::vector<ReportedPoint> described(const std::vector<std::uint32_t>& points) const {
    std::vector<ReportedPoint> list;
    for (const std::uint32_t i : points) {
      list.push_back({cloud_.index_in_file(i), cloud_.points[i], deviations_.of_points[i],
                      deviations_.nearest[i]});
    }
    return list;
  }

  void draw(const std::vector<std::uint32_t>& shown, double reach, ReportMeasurement& m) const {
    DeviationScene scene;
    scene.mesh = mesh_;
    scene.is_signed = m.is_signed;
    scene.reach = reach;
    scene.unit = wishes_.unit;
    for (const std::uint32_t i : shown) {
      scene.points.push_back(cloud_.points[i]);
      scene.deviations.push_back(deviations_.of_points[i]);
      scene.nearest.push_back(deviations_.nearest[i]);
    }
    const View view = view_of(mesh_, scene.points);
    m.geometry.up = view.up;
    if (wishes_.page) m.page_picture = deviation_picture(scene, view, kPagePicture, threads_);
    if (wishes_.picture) m.picture = deviation_picture(scene, view, kPicture, threads_);
  }

  const PointCloud& cloud_;
  MeshView mesh_;
  const std::vector<std::uint32_t>& excluded_;
  std::optional<double> epsilon_;
  ReportWishes wishes_;
  std::size_t threads_;
  Deviations deviations_;
};

}  // namespace

ReportMeasurement measure_for_report(const PointCloud& cloud, MeshView mesh,
                                     const std::vector<std::uint32_t>& excluded,
                                     std::optional<double> epsilon, const ReportWishes& wishes,
                                     std::size_t threads) {
  return Measurement(cloud, mesh, excluded, epsilon, wishes, threads).take();
}

}  // namespace emax
