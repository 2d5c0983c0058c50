#include "host/app/result_regions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/app/scan.h"
#include "host/picture/colour.h"

namespace emax {
namespace {

constexpr std::size_t kShownPlanes = 10;
constexpr double kOnPlane = 1e-6;  // of the tolerance: what lies on a plane but for rounding

}  // namespace

ResultRegions regions_of(const TriangleMesh& mesh, const PlaneParts& parts, double apart) {
  const std::vector<Plane>& planes = parts.planes;
  std::vector<ResultRegion> all(planes.size());
  const std::vector<std::uint32_t> plane_of = planes_under(mesh, planes, apart);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (plane_of[t] == PlaneParts::kNoPlane) continue;
    const auto corners = mesh.view().corners(t);
    ResultRegion& region = all[plane_of[t]];
    ++region.triangles;
    region.area += 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  }
  ResultRegions result;
  std::vector<std::uint32_t> number(planes.size(), TriangleGroups::kNone);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    if (all[p].triangles == 0) continue;
    number[p] = static_cast<std::uint32_t>(result.regions.size());
    all[p].name = fmt::format("plane_{}", p + 1);
    all[p].plane = planes[p];
    all[p].points = parts.support[p].points;
    all[p].rms = parts.support[p].rms;
    result.groups.groups.push_back({all[p].name, distinct_colour(p)});
    result.regions.push_back(all[p]);
  }
  for (const std::uint32_t plane : plane_of) {
    const bool none = plane == PlaneParts::kNoPlane;
    result.groups.group_of.push_back(none ? TriangleGroups::kNone : number[plane]);
  }
  return result;
}

double beside_plane(const TriangleMesh& extent, Storage storage, double epsilon) {
  return 2 * storage_displacement(extent, storage) + kOnPlane * epsilon;
}

void print(Facts& facts, const ResultRegions& result, const PlaneParts& parts) {
  std::size_t triangles = 0, points = 0;
  for (const ResultRegion& region : result.regions) triangles += region.triangles;
  for (const PlaneParts::Support& support : parts.support) points += support.points;
  facts.add("planes", "{} found, with {} of the points; {} triangles lie on {} of them",
            parts.planes.size(), grouped(points), grouped(triangles), result.regions.size());
  for (std::size_t i = 0; i < std::min(kShownPlanes, result.regions.size()); ++i) {
    const ResultRegion& region = result.regions[i];
    const Point& n = region.plane.normal;
    facts.add(
        region.name,
        "{} triangles, area {:.4g}, rms {:.2g}: normal ({:.5f}, {:.5f}, {:.5f}), offset {:.6g}",
        grouped(region.triangles), region.area, region.rms, n.x(), n.y(), n.z(),
        region.plane.offset);
  }
  if (result.regions.size() > kShownPlanes) {
    facts.add("...", "{} smaller ones; --json has them", result.regions.size() - kShownPlanes);
  }
}

}  // namespace emax
