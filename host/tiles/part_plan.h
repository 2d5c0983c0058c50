#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter.h"
#include "host/tiles/normal_signs.h"

namespace emax {

// What is done with each part of a cloud, in this order; every step of a part reads what the steps
// before wrote of it and its neighbours, and a plan.
enum class PartStep {
  kLook,  // its points with their neighbours: kSpacings, kComponents, kOwnNormals, kAroundNormals
  kMeasure,  // where they have a say: kExtent
  kContour,  // its surface: kVertices, kSeams, kTriangles
};
std::string_view to_string(PartStep step);
// Throws Error for another name.
PartStep part_step_named(std::string_view name);

// Files of records, one of each part. The last one of a step is written last.
inline constexpr std::string_view kSpacings = "spacings",  // double, normalised, of each point
    kComponents = "components",                            // Extremes
    kOwnNormals = "own-normals",                           // BorderNormal
    kAroundNormals = "around-normals",                     // BorderNormal
    kExtent = "extent",                                    // PartExtent, or none
    kVertices = "vertices",                                // Point
    kSeams = "seams",                                      // SeamVertex
    kTriangles = "triangles";                              // Triangle
std::filesystem::path part_file(const std::filesystem::path& folder, std::string_view what,
                                std::size_t part);
// The file that is there when the step is done.
std::filesystem::path done_file(const std::filesystem::path& folder, PartStep step,
                                std::size_t part);

// Of the points that are no stray ones; normalised.
struct PartExtent {
  Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = Eigen::Vector3f::Zero();
  float reach = 0;  // the greatest
};

// A vertex that a neighbouring part may have too, by the same name.
using SeamName = std::array<std::uint64_t, 2>;
struct SeamVertex {
  SeamName name;
  std::uint64_t vertex;  // of the part's surface
};

// Lengths are normalised.
struct PartPlan {
  ParameterValues values;  // of the method
  double thin = 0;         // thinned()
  double simplify = 0;     // deviation of collapse_by_quadrics()
  double halo = 0;         // points around a part that it is looked at with
  double compared = 0;     // distance from its border within which normals are compared
  double spacing = 0;      // known from kMeasure on
  PartExtent extent = {};  // of all parts; from kContour on, as the signs
  std::vector<std::vector<float>> signs;  // of the normals, by part and component
};
void write_plan(const std::filesystem::path& folder, const PartPlan& plan);
PartPlan read_plan(const std::filesystem::path& folder);

// Runs a step of these parts somewhere, each on its own, and calls done() after each; by one thread
// at a time. Throws Error where a part fails, and Interrupted.
using RunParts = std::function<void(PartStep step, std::span<const std::size_t> parts,
                                    const std::function<void()>& done)>;

}  // namespace emax
