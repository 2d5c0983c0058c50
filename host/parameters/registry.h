// The registry of reconstruction methods and decimators. Options and their help, error texts, the
// configuration, the genes and what runs them all come from the two lists at the end.
//
// To add a method: a struct here, its name in the list, and one source that defines run(). Its own
// parameters are named after it ("gp3.mu"); others may be shared with other methods.
#pragma once

#include <array>
#include <functional>
#include <string_view>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter.h"

namespace emax {

class BoundedStage;
class LocalCloud;
struct RunOptions;
struct DecimatedMesh;
struct Reconstruction;

// Normals of the points, which most methods need.
struct Normals {
  static constexpr ParameterKey<int> kNeighbours{
      "normals.k", 6, 40, 20, "neighbours, the point itself included, that a normal is fitted to"};
  // Hoppe's graph is sparse; more neighbours let the orientation leap between sheets.
  static constexpr ParameterKey<int> kOrientationNeighbours{
      "normals.orientation_k",
      5,
      40,
      13,
      "neighbours, the point itself included, that the orientation of normals spreads to",
      {},
      false};
};

// What holds of a method that does not say otherwise.
struct MethodDefaults {
  static constexpr bool kInterpolates = false;  // its vertices are points of the cloud
  static constexpr bool kSingleUse = false;  // a process that has run it must not reconstruct again
  static constexpr bool kSearched = true;    // one of those that a search chooses from
};

// Greedy projection triangulation.
struct Gp3 : MethodDefaults {
  static constexpr std::string_view kName = "gp3";
  static constexpr std::string_view kRemedy = "raise gp3.radius or gp3.mu";
  static constexpr bool kInterpolates = true;

  static constexpr ParameterKey<double> kRadius{
      "gp3.radius", 2, 14, 10, "greatest edge length, in multiples of the median point spacing"};
  static constexpr ParameterKey<double> kMu{
      "gp3.mu", 2, 6, 2.3,
      "search radius of a point, in multiples of the distance to its nearest neighbour"};
  static constexpr ParameterKey<int> kMaxNeighbors{"gp3.max_neighbors", 50, 300, 90,
                                                   "neighbours considered for a point"};
  static constexpr ParameterKey<double> kSurfaceAngle{
      "gp3.surface_angle", 45, 180, 110,
      "greatest angle between the normals of connected points, in degrees"};
  static constexpr ParameterKey<double> kMinAngle{
      "gp3.min_angle", 0, 10, 2, "smallest wanted angle of a triangle, in degrees"};
  static constexpr ParameterKey<double> kMaxAngle{"gp3.max_angle", 120, 175, 150,
                                                  "greatest angle of a triangle, in degrees"};

  static Parameters parameters() {
    return parameters_of(Normals::kNeighbours, Normals::kOrientationNeighbours, kRadius, kMu,
                         kMaxNeighbors, kSurfaceAngle, kMinAngle, kMaxAngle);
  }
  static Reconstruction run(const LocalCloud& cloud, const ParameterValues& values,
                            std::size_t threads);
};

struct Poisson : MethodDefaults {
  static constexpr std::string_view kName = "poisson";
  static constexpr std::string_view kRemedy = "change poisson.depth or take another method";
  static constexpr bool kSingleUse = true;  // PCL's corrupts memory when a process runs it twice

  static constexpr ParameterKey<int> kDepth{"poisson.depth", 6, 10, 8, "depth of the octree"};
  static constexpr ParameterKey<double> kSamplesPerNode{"poisson.samples_per_node", 1, 5, 1,
                                                        "points that an octree cell should hold"};
  static constexpr ParameterKey<double> kScale{
      "poisson.scale", 1.05, 1.3, 1.1,
      "side of the solved cube, in multiples of the cloud's width"};
  static constexpr ParameterKey<double> kTrim{
      "poisson.trim",
      1,
      20,
      2,
      "distance from the points up to which the surface is kept, in multiples of the point spacing "
      "around",
      {},
      false};

  static Parameters parameters() {
    return parameters_of(Normals::kNeighbours.with_standard(15), Normals::kOrientationNeighbours,
                         kDepth, kSamplesPerNode, kScale, kTrim);
  }
  static Reconstruction run(const LocalCloud& cloud, const ParameterValues& values,
                            std::size_t threads);
};

// Marching cubes on the distance to tangent planes.
struct Hoppe : MethodDefaults {
  static constexpr std::string_view kName = "hoppe";
  static constexpr std::string_view kRemedy = "raise hoppe.reach or lower hoppe.resolution";

  static constexpr ParameterKey<int> kResolution{
      "hoppe.resolution", 32, 200, 128,
      "cubic cells of the marching grid along the longest side of the cloud"};
  static constexpr ParameterKey<double> kReach{
      "hoppe.reach", 0.5, 4, 1,
      "distance from the cloud up to which space is contoured, in multiples of cell diagonal + "
      "median point spacing"};

  static Parameters parameters() {
    return parameters_of(Normals::kNeighbours.with_standard(15), Normals::kOrientationNeighbours,
                         kResolution, kReach);
  }
  static Reconstruction run(const LocalCloud& cloud, const ParameterValues& values,
                            std::size_t threads);
};

// Implicit moving least squares.
struct Imls : MethodDefaults {
  static constexpr std::string_view kName = "imls";
  static constexpr std::string_view kRemedy = "raise imls.reach or lower imls.cell";

  static constexpr ParameterKey<double> kCell{
      "imls.cell", 0.5, 3, 1,
      "side of the marching cubes, in multiples of the median point spacing"};
  static constexpr ParameterKey<double> kReach{
      "imls.reach", 2, 8, 3,
      "radius within which a point counts, in multiples of the point spacing around it"};
  static constexpr ParameterKey<double> kLeastReach{
      "imls.least_reach", 0, 16, 0,
      "that radius at least, in multiples of the median point spacing; eight times the noise "
      "smooths it"};

  static Parameters parameters() {
    return parameters_of(Normals::kNeighbours, Normals::kOrientationNeighbours, kCell, kReach,
                         kLeastReach);
  }
  static Reconstruction run(const LocalCloud& cloud, const ParameterValues& values,
                            std::size_t threads);
};

// Planes and cylinders of the scan, each spanned between its points and up to those that it meets,
// and Gp3 for the rest. Of scans of buildings and of parts that have such shapes; on others patches
// that happen to fit a shape stand apart, so it is for whoever names it.
struct Shapes : MethodDefaults {
  static constexpr std::string_view kName = "shapes";
  static constexpr std::string_view kRemedy = "raise shapes.reach or take another method";
  static constexpr bool kSearched = false;

  static constexpr ParameterKey<double> kReach{
      "shapes.reach", 2, 20, 6,
      "half the widest gap that a shape spans, in multiples of the distance of its points"};
  static constexpr ParameterKey<double> kBand{
      "shapes.band", 2, 8, 5,
      "farthest that a point of a shape lies from it, in multiples of the scan's noise"};
  static constexpr ParameterKey<int> kLeastPoints{"shapes.least_points", 30, 1000, 100,
                                                  "fewest points of a shape"};

  static Parameters parameters() {
    return parameters_of(kReach, kBand, kLeastPoints, Normals::kNeighbours,
                         Normals::kOrientationNeighbours, Gp3::kRadius, Gp3::kMu,
                         Gp3::kMaxNeighbors, Gp3::kSurfaceAngle, Gp3::kMinAngle, Gp3::kMaxAngle);
  }
  static Reconstruction run(const LocalCloud& cloud, const ParameterValues& values,
                            std::size_t threads);
};

// Moving least squares of the cloud before a method; without values for them there are none.
struct Mls {
  enum class Method { kNone, kSmooth, kResample };

  static constexpr std::array<std::string_view, 3> kMethods = {"as it is", "smoothed",
                                                               "smoothed and thinned"};
  static constexpr ParameterKey<Method> kMethod{"mls.method",
                                                Method::kNone,
                                                Method::kResample,
                                                Method::kNone,
                                                "the cloud on its moving least squares surface",
                                                kMethods};
  static constexpr ParameterKey<double> kRadius{
      "mls.radius", 2, 10, 4,
      "radius of the neighbourhood of a point, in multiples of the median point spacing"};
  static constexpr ParameterKey<int> kOrder{"mls.order", 1, 3, 2, "degree of the polynomial"};
  static constexpr ParameterKey<double> kCell{
      "mls.cell", 0.5, 3, 1,
      "side of the cells that keep one point, in multiples of the median point spacing"};

  static Parameters parameters();
  static Method method(const ParameterValues& values) {
    return values.find(kMethod).value_or(Method::kNone);
  }
};

// Holes of the surface, after a method. Without a value for the method they are filled flat.
struct Fill {
  enum class Method { kNone, kFlat, kSmooth };

  static constexpr std::array<std::string_view, 3> kMethods = {
      "none is filled", "filled", "filled with new vertices by moving least squares"};
  static constexpr ParameterKey<Method> kMethod{
      "fill.method", Method::kNone, Method::kSmooth, Method::kFlat, "what is done about holes",
      kMethods};
  static constexpr ParameterKey<double> kSize{
      "fill.size", 0, 0.2, 0.2,
      "greatest hole to fill, its radius as a share of the width; 0 fills none"};

  static Parameters parameters();
  static Method method(const ParameterValues& values) {
    return values.find(kMethod).value_or(Method::kFlat);
  }
};

// Planes of the scan that the bounded decimator follows, or all its planes, cylinders and spheres;
// without a value for the method, none.
struct PlaneFeatures {
  enum class Method { kNone, kPlanes, kAll };

  static constexpr std::array<std::string_view, 3> kMethods = {"none", "planes", "all"};
  static constexpr ParameterKey<Method> kMethod{"features.method",
                                                Method::kNone,
                                                Method::kAll,
                                                Method::kNone,
                                                "the features of the scan that vertices are put on",
                                                kMethods};
  static constexpr ParameterKey<double> kBand{
      "features.band", 0.25, 0.75, 0.5,
      "greatest distance of a point from its plane, as a share of the tolerance"};
  static constexpr ParameterKey<int> kLeastPoints{"features.least_points", 30, 1000, 100,
                                                  "points that a plane has at least"};
  static constexpr ParameterKey<bool> kSpread{
      "features.spread", false, true, true,
      "1: the error is spread evenly on planes, too: fewer triangles, and edges beside curved "
      "surfaces less near to the true ones"};

  static Parameters parameters();
  static Method method(const ParameterValues& values) {
    return values.find(kMethod).value_or(Method::kNone);
  }
};

// Every edit keeps the bound that a run fixes before its search.
struct Bounded {
  static constexpr std::string_view kName = "bounded";
  static constexpr std::string_view kMeaning = "every edit keeps the bound";
  static constexpr bool kBounded = true;
  static constexpr std::string_view kMonotone = {};

  static constexpr int kDeepEffort = 3;
  static constexpr ParameterKey<int> kEffort{
      "bounded.effort",
      0,
      kDeepEffort,
      2,
      "0: edge collapses far below the bound; 1: all edge collapses; 2: also relocations, edge "
      "flips and mended collapses; 3: all of these until none gains",
      {},
      false};
  static constexpr ParameterKey<double> kNormalCosine{
      "bounded.normal_cosine", -0.5, 0.9, 0.2,
      "least cosine between a triangle and the one that it replaces"};
  static constexpr ParameterKey<double> kFlatness{
      "bounded.flatness", 1e-4, 0.01, 1e-3, "least height of a new triangle over its longest side"};
  // Of the command `decimate`, which has no genes.
  static constexpr ParameterKey<double> kFeatureAngle{
      "bounded.feature_angle", 0, 180, 0, "angle from which an edge is a feature; 0: none is"};
  static constexpr ParameterKey<bool> kHoppe{"bounded.hoppe", false, true, false,
                                             "1: for the least energy of Hoppe et al. (1993)"};

  static Parameters parameters() { return parameters_of(kEffort, kNormalCosine, kFlatness); }
  // Keeps every bound that `start` keeps, and its topology; under a one-sided bound without the
  // components that no point needs any more. The same holds of a mesh after an early end.
  static DecimatedMesh run(const TriangleMesh& start, const ParameterValues& values,
                           const BoundedStage& stage, const RunOptions& options);
};

// Through VTK.
struct Schroeder {
  static constexpr std::string_view kName = "schroeder";
  static constexpr std::string_view kMeaning =
      "the paper's decimation, whose error is measured afterwards";
  static constexpr bool kBounded = false;

  static constexpr ParameterKey<double> kReduction{"schroeder.reduction", 0, 0.98, 0.75,
                                                   "share of the triangles to remove"};
  static constexpr std::string_view kMonotone = kReduction.name;
  static constexpr ParameterKey<double> kFeatureAngle{
      "schroeder.feature_angle", 5, 90, 55,
      "angle between triangles from which their edge is a feature, in degrees"};
  static constexpr ParameterKey<bool> kAccumulateError{
      "schroeder.accumulate_error", false, true, true,
      "1: a vertex inherits the error of those removed around it; 0: errors are local"};
  static constexpr ParameterKey<bool> kPreserveTopology{"schroeder.preserve_topology", false, true,
                                                        true, "1: no splits, no holes closed"};
  static constexpr ParameterKey<bool> kSplitting{"schroeder.splitting", false, true, false,
                                                 "1: the mesh may be split to go on"};
  static constexpr ParameterKey<bool> kBoundaryVertexDeletion{
      "schroeder.boundary_vertex_deletion", false, true, true,
      "1: boundary vertices may be removed"};

  static Parameters parameters() {
    return parameters_of(kReduction, kFeatureAngle, kAccumulateError, kPreserveTopology, kSplitting,
                         kBoundaryVertexDeletion);
  }
  // The vertices that remain are vertices of the mesh given. Throws Error when nothing is left.
  static TriangleMesh run(const TriangleMesh& mesh, const ParameterValues& values);
};

template <typename... T>
struct TypeList {};

using ReconstructionMethods = TypeList<Gp3, Poisson, Hoppe, Imls, Shapes>;
using Decimators = TypeList<Bounded, Schroeder>;

}  // namespace emax
