#include <meshoptimizer.h>

#include <memory>

#include "host/geometry/bounds.h"
#include "host/surface/mesh_orientation.h"
#include "tests/benchmarks/decimation/tool.h"

namespace emax::benchmarks {
namespace {

// binary32 around the middle; the vertices that stay are those of the start.
struct Start {
  explicit Start(const TriangleMesh& given) : mesh(given) {
    const Point midpoint = bounds_of(given.vertices).midpoint();
    for (const Point& p : given.vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        positions.push_back(static_cast<float>(p[axis] - midpoint[axis]));
      }
    }
    for (const Triangle& t : given.triangles) indices.insert(indices.end(), t.begin(), t.end());
    extent = meshopt_simplifyScale(positions.data(), given.vertices.size(), kStride);
  }

  TriangleMesh simplified(std::size_t triangles, float error, unsigned int options,
                          bool sloppy) const {
    std::vector<unsigned int> left(indices.size());
    const std::size_t vertices = mesh.vertices.size();
    left.resize(
        sloppy
            ? meshopt_simplifySloppy(left.data(), indices.data(), indices.size(), positions.data(),
                                     vertices, kStride, 3 * triangles, error, nullptr)
            : meshopt_simplify(left.data(), indices.data(), indices.size(), positions.data(),
                               vertices, kStride, 3 * triangles, error, options, nullptr));
    TriangleMesh result;
    result.vertices = mesh.vertices;
    for (std::size_t i = 0; i < left.size(); i += 3) {
      result.triangles.push_back({left[i], left[i + 1], left[i + 2]});
    }
    drop_unused(result);
    return result;
  }

  static constexpr std::size_t kStride = 3 * sizeof(float);

  TriangleMesh mesh;
  std::vector<float> positions;
  std::vector<unsigned int> indices;
  float extent;
};

}  // namespace

Tool meshoptimizer_tool() {
  const auto sets = [](const TriangleMesh& mesh, double epsilon) {
    using enum OptionSet::Parameter;
    constexpr float kAny = 1e9F;
    const auto start = std::make_shared<const Start>(mesh);
    const auto to_count = [=](unsigned int options, bool sloppy) {
      return [=](double triangles) {
        return start->simplified(static_cast<std::size_t>(triangles), kAny, options, sloppy);
      };
    };
    const auto to_error = [=](unsigned int options) {
      return [=](double error) {
        return start->simplified(0, static_cast<float>(error * epsilon) / start->extent, options,
                                 false);
      };
    };
    return std::vector<OptionSet>{
        {"to a number", kTriangles, to_count(0, false)},
        {"to a number, LockBorder", kTriangles, to_count(meshopt_SimplifyLockBorder, false)},
        {"target_error", kTolerance, to_error(0)},
        {"target_error, LockBorder", kTolerance, to_error(meshopt_SimplifyLockBorder)},
        {"sloppy", kTriangles, to_count(0, true)},
    };
  };
  return {"meshoptimizer", "meshoptimizer",
          std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." +
              std::to_string(MESHOPTIMIZER_VERSION % 1000 / 10),
          sets};
}

}  // namespace emax::benchmarks
