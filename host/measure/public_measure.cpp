#include <emax/measure.h>

#include "host/engine/error_engine.h"
#include "host/engine/mesh_batch.h"
#include "host/measure/point_distances.h"
#include "sw_model/base/public_arguments.h"

namespace emax {
inline namespace v1 {
namespace {

std::size_t checked_threads(std::size_t threads) {
  if (threads == 0) throw Error("threads: at least one");
  return threads;
}

Measurement measurement(const PreparedCloud& cloud, const EmaxResult& result) {
  return {in_file_units(cloud.normalization(), result.squared_bits), result.worst_point,
          result.squared_bits};
}

}  // namespace

struct ErrorMeter::Parts {
  Parts(Coordinates coordinates, std::size_t how_many)
      : cloud(checked_points(coordinates, "cloud")),
        engine(cloud, {.threads = checked_threads(how_many)}),
        threads(how_many) {}

  PreparedMesh prepared(SurfaceSpan mesh) const {
    require_no_flush_of_caller();
    return PreparedMesh(checked_surface(mesh, "mesh").view(), cloud.normalization(),
                        engine.target(), threads);
  }

  PreparedCloud cloud;
  ErrorEngine engine;
  std::size_t threads;
};

ErrorMeter::ErrorMeter(Coordinates cloud, std::size_t threads) {
  require_no_flush_of_caller();
  parts_ = std::make_unique<Parts>(cloud, threads);
}
ErrorMeter::~ErrorMeter() = default;
ErrorMeter::ErrorMeter(ErrorMeter&&) noexcept = default;
ErrorMeter& ErrorMeter::operator=(ErrorMeter&&) noexcept = default;

Measurement ErrorMeter::e_max(SurfaceSpan mesh) {
  return measurement(parts_->cloud, parts_->engine.e_max(parts_->prepared(mesh)));
}

double ErrorMeter::quantile(SurfaceSpan mesh, double share) {
  if (!(share > 0 && share <= 1)) throw Error("share: above 0 and at most 1");
  return in_file_units(parts_->cloud.normalization(),
                       parts_->engine.quantile(parts_->prepared(mesh), share).squared_bits);
}

std::vector<double> ErrorMeter::distances(SurfaceSpan mesh) {
  std::vector<double> distances;
  for (const std::uint32_t bits : parts_->engine.squared_distances(parts_->prepared(mesh))) {
    distances.push_back(in_file_units(parts_->cloud.normalization(), bits));
  }
  return distances;
}

double ErrorMeter::margin(SurfaceSpan mesh, double distance) const {
  const Normalization& normalization = parts_->cloud.normalization();
  const MeshExtent extent(checked_surface(mesh, "mesh").view(), normalization);
  return point_distance_margin(normalization, extent, distance);
}

std::vector<Measurement> e_max_of_each(Coordinates cloud, std::span<const SurfaceSpan> meshes,
                                       std::size_t threads) {
  require_no_flush_of_caller();
  const PreparedCloud prepared(checked_points(cloud, "cloud"));
  std::vector<OwnedSurface> surfaces;
  std::vector<MeshView> views;
  for (const SurfaceSpan& mesh : meshes) {
    surfaces.push_back(checked_surface(mesh, "meshes[" + std::to_string(surfaces.size()) + "]"));
  }
  for (const OwnedSurface& surface : surfaces) views.push_back(surface.view());
  std::vector<Measurement> results;
  for (const EmaxResult& result :
       emax::e_max_of_each(prepared, views, {.threads = checked_threads(threads)})) {
    results.push_back(measurement(prepared, result));
  }
  return results;
}

}  // namespace v1
}  // namespace emax
