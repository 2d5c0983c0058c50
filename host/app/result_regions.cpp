#include "host/app/result_regions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/app/scan.h"
#include "host/picture/colour.h"
#include "host/report/shape_text.h"

namespace emax {
namespace {

constexpr std::size_t kShownShapes = 10;
constexpr double kOnShape = 1e-6;  // of the tolerance: what lies on a shape but for rounding

}  // namespace

ResultRegions regions_of(const TriangleMesh& mesh, const PlaneParts& parts, double apart,
                         double epsilon) {
  const std::vector<Shape> shapes = parts.shapes();
  std::vector<ResultRegion> all(shapes.size());
  const std::vector<std::uint32_t> shape_of =
      shapes_under(mesh, shapes, apart, kBesideShape * epsilon);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (shape_of[t] == PlaneParts::kNoPlane) continue;
    const auto corners = mesh.view().corners(t);
    ResultRegion& region = all[shape_of[t]];
    ++region.triangles;
    region.area += 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  }
  ResultRegions result;
  std::vector<std::uint32_t> number(shapes.size(), TriangleGroups::kNone);
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    if (all[s].triangles == 0) continue;
    number[s] = static_cast<std::uint32_t>(result.regions.size());
    all[s].name = fmt::format("{}_{}", kind_of(shapes[s]), s + 1);
    all[s].shape = shapes[s];
    all[s].points = parts.support[s].points;
    all[s].rms = parts.support[s].rms;
    result.groups.groups.push_back({all[s].name, distinct_colour(s)});
    result.regions.push_back(all[s]);
  }
  for (const std::uint32_t shape : shape_of) {
    const bool none = shape == PlaneParts::kNoPlane;
    result.groups.group_of.push_back(none ? TriangleGroups::kNone : number[shape]);
  }
  return result;
}

double beside_shape(const TriangleMesh& extent, Storage storage, double epsilon) {
  return 2 * storage_displacement(extent, storage) + kOnShape * epsilon;
}

void print(Facts& facts, const ResultRegions& result, const PlaneParts& parts) {
  std::size_t triangles = 0, points = 0;
  for (const ResultRegion& region : result.regions) triangles += region.triangles;
  for (const PlaneParts::Support& support : parts.support) points += support.points;
  facts.add(parts.curved.empty() ? "planes" : "shapes",
            "{} found, with {} of the points; {} triangles lie on {} of them", parts.support.size(),
            grouped(points), grouped(triangles), result.regions.size());
  for (std::size_t i = 0; i < std::min(kShownShapes, result.regions.size()); ++i) {
    const ResultRegion& region = result.regions[i];
    facts.add(region.name, "{} triangles, area {:.4g}, rms {:.2g}: {}", grouped(region.triangles),
              region.area, region.rms, equation_text(region.shape));
  }
  if (result.regions.size() > kShownShapes) {
    facts.add("...", "{} smaller ones; --json has them", result.regions.size() - kShownShapes);
  }
}

}  // namespace emax
