#include "sw_model/base/public_arguments.h"

#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"

namespace emax {
namespace {

[[noreturn]] void refuse(std::string_view name, const std::string& why) {
  throw Error(std::string(name) + ": " + why);
}

}  // namespace

std::vector<Point> checked_points(Coordinates coordinates, std::string_view name) {
  if (coordinates.empty()) refuse(name, "no points");
  if (coordinates.size() % 3 != 0) {
    refuse(name, std::to_string(coordinates.size()) + " numbers are not three a point");
  }
  std::vector<Point> points(coordinates.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
    if (!points[i].allFinite()) refuse(name, "point " + std::to_string(i) + " is not finite");
  }
  return points;
}

OwnedSurface checked_surface(SurfaceSpan surface, std::string_view name) {
  OwnedSurface result = {checked_points(surface.coordinates, name), {}};
  if (surface.indices.empty()) refuse(name, "no triangles");
  if (surface.indices.size() % 3 != 0) {
    refuse(name, std::to_string(surface.indices.size()) + " indices are not three a triangle");
  }
  result.triangles.resize(surface.indices.size() / 3);
  for (std::size_t i = 0; i < surface.indices.size(); ++i) {
    if (surface.indices[i] >= result.vertices.size()) {
      refuse(name, "triangle " + std::to_string(i / 3) + " has the index " +
                       std::to_string(surface.indices[i]) + " of " +
                       std::to_string(result.vertices.size()) + " points");
    }
    result.triangles[i / 3][i % 3] = surface.indices[i];
  }
  return result;
}

Surface as_public(MeshView mesh) {
  Surface surface;
  surface.coordinates.reserve(3 * mesh.vertices.size());
  for (const Point& p : mesh.vertices) {
    surface.coordinates.insert(surface.coordinates.end(), p.data(), p.data() + 3);
  }
  surface.indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    surface.indices.insert(surface.indices.end(), t.begin(), t.end());
  }
  return surface;
}

void require_no_flush_of_caller() {
  if (flush_mode_is_on()) {
    throw Error(
        "this thread flushes subnormals (was something linked with -ffast-math?); turn it off "
        "around the call");
  }
}

}  // namespace emax
