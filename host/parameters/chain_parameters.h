#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter.h"

namespace emax {

// One candidate's way through the chain. Beside the parameters of the method there may be those of
// Mls, Fill::kMethod and those of PlaneFeatures; without them there are no moving least squares,
// holes are filled without new vertices, and no planes are followed.
struct ChainSettings {
  std::string method;     // one of reconstruction_methods(), or kFitMethod
  std::string decimator;  // one of decimators(), or kNoDecimator
  ParameterValues parameters;
};

// What the stages took; 0 for one whose result was kept.
struct StageSeconds {
  double reconstruct = 0;
  double prepare =
      0;  // holes filled; for the bounded decimator, made manifold, far points inserted
  double decimate = 0;
  double check = 0;  // of the back bound

  double sum() const { return reconstruct + prepare + decimate + check; }
  StageSeconds& operator+=(const StageSeconds& other) {
    reconstruct += other.reconstruct;
    prepare += other.prepare;
    decimate += other.decimate;
    check += other.check;
    return *this;
  }
};

struct ChainResult {
  TriangleMesh mesh;
  std::size_t reconstruction_triangles = 0;  // before filling and decimation
  std::size_t unmeshed_points = 0;           // see Reconstruction
  // Of the bounded decimator under a two-sided bound: components, border loops and handles more or
  // fewer than the reference's, added up.
  std::size_t topology_difference = 0;
  // How far the mesh strays from the reference, certified; more than epsilon_back exactly where it
  // breaks the bound.
  double back_distance = 0;
  // And how far any point of the reference is from the mesh; more than epsilon exactly where that
  // bound is broken.
  double reference_distance = 0;
  bool stopped = false;  // the decimation was, before its end: the mesh is the one at hand
  // Where it ended early, because it would hardly have come below its rival: what all of it would
  // have left, estimated. Otherwise 0.
  std::size_t expected_triangles = 0;
  StageSeconds seconds = {};
};

// What a stage's result depends on: the method and the values of its genes and of those before it.
using StageKey = std::pair<std::string, ParameterValues>;
ParameterValues cloud_key(const ChainSettings& settings);  // of the cloud moved; no method yet
StageKey reconstruction_key(const ChainSettings& settings);
StageKey surface_key(const ChainSettings& settings);  // its holes filled

// In place of a decimator: the chain ends with the surface, its holes filled.
inline constexpr const char* kNoDecimator = "none";
// In place of a decimator: all of them, as a gene.
inline constexpr const char* kAutoDecimator = "auto";

// In place of a method: every one of them, as a gene, with moving least squares and the ways to
// fill holes.
inline constexpr const char* kAutoMethod = "auto";
// In place of a method: the bound's reference surface as it is, whatever made it. No P_R.
inline constexpr const char* kFitMethod = "fit";

// What a run's candidates do about the features of the scan: none, planes, all shapes, or planes as
// a gene.
inline constexpr const char* kNoFeatures = "none";
inline constexpr const char* kOnPlanes = "planes";
inline constexpr const char* kAllFeatures = "all";
inline constexpr const char* kAutoFeatures = "auto";

// That of a run's candidates: the method itself, but for kFitMethod with a decimator that knows no
// reference the first of reconstruction_methods(), and kFitMethod for a method that is not searched
// with a decimator that knows one: it makes the reference.
std::string method_for(const std::string& method, const std::string& decimator);

// Whether a run with this decimator fixes a bound before its search, because a candidate may be
// held to it; with kNoDecimator it is, too. Throws Error when there is no such decimator.
bool takes_bound(std::string_view decimator);
// Whether every candidate keeps that bound in all directions. Likewise.
bool keeps_bound(std::string_view decimator);

// P_R of the method, hole filling, P_D of the decimator: the chromosome in the order of its genes
// (paper, section 3). With kAutoMethod and kAutoDecimator the own parameters of each have a meaning
// only with theirs; with kNoDecimator there is no P_D. Throws Error when there is no such method or
// decimator.
//
// With features other than kNoFeatures the parameters of PlaneFeatures come last; with kOnPlanes
// the planes are always followed, with kAllFeatures cylinders and spheres, too.
Parameters chain_parameters(std::string_view method, std::string_view decimator,
                            std::string_view features = kNoFeatures);

// The candidate that values of chain_parameters(method, decimator) are: its method, its decimator
// and the values that have a meaning with them.
ChainSettings chain_settings(const std::string& method, const std::string& decimator,
                             const ParameterValues& values);

// The values by which planes are found for the candidate; empty where it follows none.
ParameterValues features_key(const ChainSettings& settings);

// Throws Error when a candidate lacks a value that its stages ask for, and when there is no such
// method or decimator.
void require_values(const ChainSettings& settings);

}  // namespace emax
