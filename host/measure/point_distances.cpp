#include "host/measure/point_distances.h"

#include "sw_model/model/error_bound.h"

namespace emax {

double in_file_units(const Normalization& normalization, std::uint32_t squared_bits) {
  return distance_of(squared_bits) / normalization.scale;
}

std::vector<double> point_distances(const PreparedCloud& cloud, MeshView mesh,
                                    const std::function<bool()>& interrupted, std::size_t threads) {
  ErrorEngine engine(cloud, {.threads = threads, .interrupted = interrupted});
  return point_distances(cloud, engine,
                         PreparedMesh(mesh, cloud.normalization(), engine.target(), threads));
}

std::vector<double> point_distances(const PreparedCloud& cloud, ErrorEngine& engine,
                                    const PreparedMesh& mesh) {
  std::vector<double> distances;
  distances.reserve(cloud.points().size());
  for (const std::uint32_t bits : engine.squared_distances(mesh)) {
    distances.push_back(in_file_units(cloud.normalization(), bits));
  }
  return distances;
}

double point_distance_margin(const Normalization& normalization, const MeshExtent& mesh,
                             double distance) {
  // No edge is longer than the diagonal. The margin is doubled for the rounding of the point
  // itself.
  return 2 *
         kernel_distance_margin(normalization.length(distance),
                                2 * normalization.length((mesh.upper - mesh.lower).norm()),
                                normalization.length(mesh.farthest)) /
         normalization.scale;
}

}  // namespace emax
