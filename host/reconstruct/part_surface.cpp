#include "host/reconstruct/part_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "host/decimate/quadric_collapse.h"
#include "host/reconstruct/imls.h"
#include "host/reconstruct/local_cloud.h"
#include "host/tiles/cloud_partition.h"
#include "host/tiles/records.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// A part's own point as its cloud makes it. Files of them are read by this step and later ones
// alone.
struct Sample {
  SampledPoint point;
  std::uint64_t number;
  std::uint64_t component;
};
constexpr std::string_view kSamples = "samples";

class PartWork {
 public:
  PartWork(const std::filesystem::path& folder, std::size_t part)
      : folder_(folder), part_(part), cloud_(folder), plan_(read_plan(folder)) {}

  void look() {
    const std::vector<NumberedPoint> points =
        thinned(cloud_.read(part_, plan_.halo), cloud_.normalization(), plan_.thin);
    std::vector<Point> positions;
    for (const NumberedPoint& p : points) positions.push_back(p.position);
    std::vector<Sample> own;
    PartNormals normals;
    if (const std::optional<LocalCloud> local = local_cloud(positions)) {
      const SampledCloud sampled = sample(*local, plan_.values, 1);
      for (std::size_t i = 0; i < local->size(); ++i) {
        const std::uint64_t number = points[local->index(i)].number;
        if (!take(sampled.points[i], sampled.part[i], number, own, normals)) continue;
        Extremes& extremes = component(normals, sampled.part[i]);
        extend(extremes, sampled.points[i].position, sampled.fitted[i], number);
      }
    }
    // What is around may belong to components that have no point of the part.
    for (const BorderNormal& n : normals.around) component(normals, n.component);
    std::vector<double> spacings;
    for (const Sample& s : own) spacings.push_back(s.point.spacing);
    write<Sample>(kSamples, own);
    write<double>(kSpacings, spacings);
    write<Extremes>(kComponents, normals.components);
    write<BorderNormal>(kOwnNormals, normals.own);
    write<BorderNormal>(kAroundNormals, normals.around);
  }

  void measure() const {
    const PointShape shape(plan_.values, plan_.spacing);
    Eigen::AlignedBox3f box;
    float reach = 0;
    for_each_sample(part_, [&](const Sample& s) {
      if (const std::optional<OrientedPoint> point = shape(s.point)) {
        box.extend(point->position);
        reach = std::max(reach, point->reach);
      }
    });
    std::vector<PartExtent> extent;
    if (!box.isEmpty()) extent.push_back({box.min(), box.max(), reach});
    write<PartExtent>(kExtent, extent);
  }

  void contour() const {
    const PointShape shape(plan_.values, plan_.spacing);
    const Lattice lattice(plan_.extent.low, plan_.extent.high, plan_.extent.reach, shape.cell());
    const CubeRange cubes = cubes_of(lattice);
    const ImplicitMesh contoured = implicit_surface(points_around(shape), lattice, cubes);
    std::vector<char> at_seams(contoured.vertices.size());
    for (std::size_t v = 0; v < at_seams.size(); ++v) {
      const Eigen::Array3i node = lowest_node(contoured.names[v][0]).array();
      at_seams[v] = (node == cubes.first.array()).any() || (node == cubes.last.array()).any();
    }
    const CollapsedMesh mesh = simplified(contoured, at_seams);
    std::vector<Point> vertices;
    std::vector<SeamVertex> seams;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const std::uint32_t before = mesh.vertices[v];
      vertices.push_back(cloud_.normalization().invert(mesh.mesh.vertices[v]));
      if (at_seams[before] != 0) seams.push_back({contoured.names[before], v});
    }
    write<Point>(kVertices, vertices);
    write<SeamVertex>(kSeams, seams);
    write<Triangle>(kTriangles, mesh.mesh.triangles);
  }

 private:
  const SpacePartition::Part& box() const { return cloud_.parts()[part_]; }

  template <typename Record>
  void write(std::string_view what, std::span<const Record> records) const {
    write_records(part_file(folder_, what, part_), records);
  }

  // Nothing where there are too few points.
  std::optional<LocalCloud> local_cloud(std::span<const Point> positions) const {
    try {
      return std::optional<LocalCloud>(std::in_place, positions, cloud_.normalization());
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  // Vertices at seams stay.
  CollapsedMesh simplified(const ImplicitMesh& contoured, std::span<const char> at_seams) const {
    TriangleMesh mesh{contoured.vertices, contoured.triangles};
    if (plan_.simplify > 0 && !mesh.triangles.empty()) {
      return collapse_by_quadrics(mesh, plan_.simplify, at_seams);
    }
    std::vector<std::uint32_t> all(mesh.vertices.size());
    std::iota(all.begin(), all.end(), 0u);
    return {std::move(mesh), std::move(all)};
  }

  static Extremes& component(PartNormals& normals, std::size_t number) {
    if (number >= normals.components.size()) normals.components.resize(number + 1);
    return normals.components[number];
  }

  static void extend(Extremes& extremes, const Eigen::Vector3f& position,
                     const Eigen::Vector3f& normal, std::uint64_t number) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto side = 2 * static_cast<std::size_t>(axis);
      extremes[side].take({position[axis], normal[axis], number});
      extremes[side + 1].take({-position[axis], -normal[axis], number});
    }
  }

  // Returns whether the point is the part's own.
  bool take(const SampledPoint& point, std::uint32_t of_component, std::uint64_t number,
            std::vector<Sample>& own, PartNormals& normals) const {
    const BorderNormal normal{number, static_cast<std::uint32_t>(cloud_.part_of(point.position)),
                              of_component, point.normal};
    const Eigen::Vector3d position = point.position.cast<double>();
    if (normal.owner != part_) {
      if (squared_distance_from(box(), position) <= plan_.compared * plan_.compared) {
        normals.around.push_back(normal);
      }
      return false;
    }
    own.push_back({point, number, of_component});
    if (depth_within(box(), position) <= plan_.compared) normals.own.push_back(normal);
    return true;
  }

  void for_each_sample(std::size_t part, const std::function<void(const Sample&)>& take) const {
    read_records<Sample>(part_file(folder_, kSamples, part), [&](std::span<const Sample> piece) {
      for (const Sample& s : piece) take(s);
    });
  }

  // With a say in the cubes of the part, in the order of the numbers.
  std::vector<OrientedPoint> points_around(const PointShape& shape) const {
    const double margin = 2 * static_cast<double>(shape.cell());
    const double farthest = static_cast<double>(plan_.extent.reach) + margin;
    std::vector<std::pair<std::uint64_t, OrientedPoint>> found;
    for (std::size_t other = 0; other < cloud_.parts().size(); ++other) {
      if (!are_within(box(), cloud_.parts()[other], farthest)) continue;
      for_each_sample(other, [&](const Sample& s) {
        std::optional<OrientedPoint> point = shape(s.point);
        if (!point) return;
        const double reach = static_cast<double>(point->reach) + margin;
        if (squared_distance_from(box(), point->position.cast<double>()) > reach * reach) return;
        point->normal *= plan_.signs[other][s.component];
        found.emplace_back(s.number, *point);
      });
    }
    std::ranges::sort(found, {}, [](const auto& numbered) { return numbered.first; });
    std::vector<OrientedPoint> points;
    points.reserve(found.size());
    for (const auto& [number, point] : found) points.push_back(point);
    return points;
  }

  // Neighbouring parts have the same plane, and so the same node, between them.
  CubeRange cubes_of(const Lattice& lattice) const {
    CubeRange cubes;
    const auto node = [&](int cell, int axis) {
      const double at =
          (space_plane(cell) - lattice.origin[axis]) / static_cast<double>(lattice.cell);
      return static_cast<int>(std::clamp(std::ceil(at), 0.0, Lattice::kNodes - 1.0));
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (box().first[axis] > 0) cubes.first[axis] = node(box().first[axis], axis);
      if (box().last[axis] < kSpaceCells) cubes.last[axis] = node(box().last[axis], axis);
    }
    return cubes;
  }

  const std::filesystem::path& folder_;
  const std::size_t part_;
  const CloudPartition cloud_;
  const PartPlan plan_;
};

}  // namespace

void run_part_step(const std::filesystem::path& folder, PartStep step, std::size_t part) {
  PartWork work(folder, part);
  switch (step) {
    case PartStep::kLook:
      return work.look();
    case PartStep::kMeasure:
      return work.measure();
    case PartStep::kContour:
      return work.contour();
  }
}

}  // namespace emax
