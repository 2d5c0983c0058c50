#include "host/parameters/reconstruction_parameters.h"

#include <array>
#include <vector>

#include "sw_model/base/error.h"

namespace emax {
namespace {

using enum ParameterSpec::Kind;

ParameterSpec normals_k(double standard) {
  return {"normals.k", kInteger,
          6,           40,
          standard,    "neighbours, the point itself included, that a normal is fitted to"};
}

// Hoppe's graph is sparse; more neighbours let the orientation leap between sheets.
const ParameterSpec& orientation_k() {
  static const ParameterSpec spec = {
      "normals.orientation_k",
      kInteger,
      5,
      40,
      13,
      "neighbours, the point itself included, that the orientation of normals spreads to",
      {},
      std::nullopt,
      false};
  return spec;
}

const std::vector<ParameterSpec>& gp3() {
  static const std::vector<ParameterSpec> specs = {
      normals_k(20),
      orientation_k(),
      {"gp3.radius", kContinuous, 2, 14, 10,
       "greatest edge length, in multiples of the median point spacing"},
      {"gp3.mu", kContinuous, 2, 6, 2.3,
       "search radius of a point, in multiples of the distance to its nearest neighbour"},
      {"gp3.max_neighbors", kInteger, 50, 300, 90, "neighbours considered for a point"},
      {"gp3.surface_angle", kContinuous, 45, 180, 110,
       "greatest angle between the normals of connected points, in degrees"},
      {"gp3.min_angle", kContinuous, 0, 10, 2, "smallest wanted angle of a triangle, in degrees"},
      {"gp3.max_angle", kContinuous, 120, 175, 150, "greatest angle of a triangle, in degrees"},
  };
  return specs;
}

const std::vector<ParameterSpec>& poisson() {
  static const std::vector<ParameterSpec> specs = {
      normals_k(15),
      orientation_k(),
      {"poisson.depth", kInteger, 6, 10, 8, "depth of the octree"},
      {"poisson.samples_per_node", kContinuous, 1, 5, 1, "points that an octree cell should hold"},
      {"poisson.scale", kContinuous, 1.05, 1.3, 1.1,
       "side of the solved cube, in multiples of the cloud's width"},
      {"poisson.trim",
       kContinuous,
       1,
       20,
       2,
       "distance from the points up to which the surface is kept, in multiples of the point "
       "spacing "
       "around",
       {},
       std::nullopt,
       false},
  };
  return specs;
}

const std::vector<ParameterSpec>& hoppe() {
  static const std::vector<ParameterSpec> specs = {
      normals_k(15),
      orientation_k(),
      {"hoppe.resolution", kInteger, 32, 200, 128,
       "cubic cells of the marching grid along the longest side of the cloud"},
      {"hoppe.reach", kContinuous, 0.5, 4, 1,
       "distance from the cloud up to which space is contoured, in multiples of cell diagonal + "
       "median point spacing"},
  };
  return specs;
}

const std::vector<ParameterSpec>& imls() {
  static const std::vector<ParameterSpec> specs = {
      normals_k(20),
      orientation_k(),
      {"imls.cell", kContinuous, 0.5, 3, 1,
       "side of the marching cubes, in multiples of the median point spacing"},
      {"imls.reach", kContinuous, 2, 8, 3,
       "radius within which a point has a say, in multiples of the point spacing around it"},
      {"imls.least_reach", kContinuous, 0, 16, 0,
       "that radius at least, in multiples of the median point spacing; eight times the noise "
       "smooths it"},
  };
  return specs;
}

const std::vector<ParameterSpec>& mls() {
  static const std::string method = "mls.method";
  static const ParameterSpec::Condition used = {method, 0, true}, resampled = {method, 2};
  static const std::vector<ParameterSpec> specs = {
      {method,
       kCategorical,
       0,
       2,
       0,
       "the cloud on its moving least squares surface",
       {"as it is", "smoothed", "smoothed and thinned"}},
      {"mls.radius",
       kContinuous,
       2,
       10,
       4,
       "radius of the neighbourhood of a point, in multiples of the median point spacing",
       {},
       used},
      {"mls.order", kInteger, 1, 3, 2, "degree of the polynomial", {}, used},
      {"mls.cell",
       kContinuous,
       0.5,
       3,
       1,
       "side of the cells that keep one point, in multiples of the median point spacing",
       {},
       resampled},
  };
  return specs;
}

}  // namespace

std::span<const ParameterSpec> mls_parameters() { return mls(); }

std::span<const std::string_view> reconstruction_methods() {
  static constexpr std::array<std::string_view, 4> kMethods = {"gp3", "poisson", "hoppe", "imls"};
  return kMethods;
}

std::span<const ParameterSpec> reconstruction_parameters(std::string_view method) {
  if (method == "gp3") return gp3();
  if (method == "poisson") return poisson();
  if (method == "hoppe") return hoppe();
  if (method == "imls") return imls();
  throw Error("there is no reconstruction method '" + std::string(method) +
              "'; choose gp3, poisson, hoppe, imls or auto");
}

bool single_use(std::string_view method) { return method == "poisson"; }

}  // namespace emax
