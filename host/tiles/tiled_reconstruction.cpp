#include "host/tiles/tiled_reconstruction.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host/tiles/normal_signs.h"
#include "host/tiles/records.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// Spacings as estimate_scan() tells them: the distance of the nearest neighbour, which is half of
// what a point has of the surface, or all of it on a grid.
constexpr double kHalo = 40, kCompared = 8;
constexpr std::size_t kEstimated = 8;  // parts

struct NameHash {
  std::size_t operator()(const SeamName& name) const {
    return static_cast<std::size_t>(name[0] * 0x9e3779b97f4a7c15u ^ name[1]);
  }
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

class TiledReconstructor {
 public:
  TiledReconstructor(const CloudPartition& cloud, const RunParts& run,
                     const std::function<void(double)>& advanced)
      : cloud_(cloud), run_(run), advanced_(advanced) {}

  TiledReconstruction run(const ParameterValues& values, const ScanEstimate& estimate,
                          const Coarseness& coarseness) {
    const double spacing = cloud_.normalization().length(estimate.spacing);
    PartPlan plan;
    plan.values = values;
    plan.thin = coarseness.thin;
    plan.simplify = coarseness.simplify;
    plan.halo = kHalo * spacing;
    plan.compared = kCompared * spacing;
    run_step(PartStep::kLook, plan);
    plan.spacing = median_spacing();
    run_step(PartStep::kMeasure, plan);
    plan.extent = extent();
    plan.signs = signs();
    run_step(PartStep::kContour, plan);
    TiledReconstruction result;
    result.mesh = joined();
    result.spacing = plan.spacing / cloud_.normalization().scale;
    result.points = known_points_;
    return result;
  }

 private:
  static constexpr double kSteps = 3;

  std::size_t parts() const { return cloud_.parts().size(); }

  template <typename Record>
  std::vector<Record> records(std::string_view what, std::size_t part) const {
    return all_records<Record>(part_file(cloud_.folder(), what, part));
  }

  void run_step(PartStep step, const PartPlan& plan) {
    write_plan(cloud_.folder(), plan);
    std::vector<std::size_t> left;
    for (std::size_t part = 0; part < parts(); ++part) {
      if (!exists(done_file(cloud_.folder(), step, part))) left.push_back(part);
    }
    std::size_t done = parts() - left.size();
    const auto tell = [&] {
      const double share = static_cast<double>(done) / static_cast<double>(parts());
      if (advanced_) advanced_((static_cast<double>(step) + share) / kSteps);
    };
    run_(step, left, [&] {
      ++done;
      tell();
    });
    tell();
  }

  // Of all points. Two passes over their spacings: the first counts how many share the leading
  // bits, in whose order positive numbers are.
  double median_spacing() {
    constexpr int kDropped = 44;
    const auto leading = [](double value) {
      return static_cast<std::size_t>(std::bit_cast<std::uint64_t>(value) >> kDropped);
    };
    const auto each = [&](const auto& take) {
      for (std::size_t part = 0; part < parts(); ++part) {
        read_records<double>(part_file(cloud_.folder(), kSpacings, part),
                             [&](std::span<const double> piece) {
                               for (const double s : piece) take(s);
                             });
      }
    };
    std::vector<std::uint64_t> counts(std::size_t{1} << (64 - kDropped), 0);
    each([&](double s) {
      ++counts[leading(s)];
      ++known_points_;
    });
    if (known_points_ == 0) {
      throw Error("no part of the cloud has three distinct points; a surface needs at least three");
    }
    std::uint64_t rank = known_points_ / 2;
    std::size_t wanted = 0;
    while (counts[wanted] <= rank) rank -= counts[wanted++];
    std::vector<double> within;
    each([&](double s) {
      if (leading(s) == wanted) within.push_back(s);
    });
    const auto at = within.begin() + static_cast<std::ptrdiff_t>(rank);
    std::ranges::nth_element(within, at);
    return *at;
  }

  PartExtent extent() const {
    std::vector<PartExtent> all;
    for (std::size_t part = 0; part < parts(); ++part) {
      for (const PartExtent& e : records<PartExtent>(kExtent, part)) all.push_back(e);
    }
    if (all.empty()) throw Error("every point lies off the surface of its neighbours");
    PartExtent joint = all.front();
    for (const PartExtent& e : all) {
      joint.low = joint.low.cwiseMin(e.low);
      joint.high = joint.high.cwiseMax(e.high);
      joint.reach = std::max(joint.reach, e.reach);
    }
    return joint;
  }

  std::vector<std::vector<float>> signs() const {
    std::vector<PartNormals> normals;
    for (std::size_t part = 0; part < parts(); ++part) {
      normals.push_back({records<Extremes>(kComponents, part),
                         records<BorderNormal>(kOwnNormals, part),
                         records<BorderNormal>(kAroundNormals, part)});
    }
    return consistent_signs(normals);
  }

  TriangleMesh joined() const {
    TriangleMesh mesh;
    std::unordered_map<SeamName, std::uint32_t, NameHash> at_seams;
    for (std::size_t part = 0; part < parts(); ++part) {
      const std::vector<Point> vertices = records<Point>(kVertices, part);
      const std::vector<SeamVertex> seams = records<SeamVertex>(kSeams, part);
      std::vector<std::uint32_t> index(vertices.size(), ~0u);
      for (const SeamVertex& seam : seams) {
        const auto known = at_seams.find(seam.name);
        if (known != at_seams.end()) index[seam.vertex] = known->second;
      }
      for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (index[v] != ~0u) continue;
        index[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(vertices[v]);
      }
      for (const SeamVertex& seam : seams) at_seams.try_emplace(seam.name, index[seam.vertex]);
      for (const Triangle& t : records<Triangle>(kTriangles, part)) {
        mesh.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
      }
    }
    return mesh;
  }

  const CloudPartition& cloud_;
  const RunParts& run_;
  const std::function<void(double)>& advanced_;
  std::uint64_t known_points_ = 0;
};

}  // namespace

ScanEstimate estimate_scan(const CloudPartition& cloud, double thin) {
  std::vector<double> spacings, noises;
  const std::size_t step = std::max<std::size_t>(1, cloud.parts().size() / kEstimated);
  for (std::size_t part = 0; part < cloud.parts().size(); part += step) {
    std::vector<Point> points;
    for (const NumberedPoint& p : thinned(cloud.read(part, 0), cloud.normalization(), thin)) {
      points.push_back(p.position);
    }
    const ScanEstimate estimate = estimate_scan(points);
    if (estimate.spacing <= 0) continue;
    spacings.push_back(estimate.spacing);
    noises.push_back(estimate.noise);
  }
  return {.spacing = median(spacings), .noise = median(noises)};
}

TiledReconstruction reconstruct_in_tiles(const CloudPartition& cloud, const ParameterValues& values,
                                         const ScanEstimate& estimate, const Coarseness& coarseness,
                                         const RunParts& run,
                                         const std::function<void(double)>& advanced) {
  return TiledReconstructor(cloud, run, advanced).run(values, estimate, coarseness);
}

}  // namespace emax
