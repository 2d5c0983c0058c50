#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter_spec.h"

namespace emax {

// One candidate's way through the chain. Beside the parameters of the method there may be those of
// mls_parameters() and "fill.method"; without them there are no moving least squares, and holes are
// filled without new vertices.
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
  StageSeconds seconds = {};
};

// What a stage's result depends on: the method and the values of its genes and of those before it.
using StageKey = std::pair<std::string, ParameterValues>;
ParameterValues cloud_key(const ChainSettings& settings);  // of the cloud moved; no method yet
StageKey reconstruction_key(const ChainSettings& settings);
StageKey surface_key(const ChainSettings& settings);  // its holes filled

std::span<const std::string_view> decimators();

// P_D of a decimator with domains and standards. Throws Error when there is no such decimator.
std::span<const ParameterSpec> decimation_parameters(std::string_view decimator);

// Of the bounded decimator: DecimationSettings::Effort.
inline constexpr const char* kBoundedEffort = "bounded.effort";
inline constexpr double kDeepEffort = 3;

// In place of a decimator: the chain ends with the surface, its holes filled.
inline constexpr const char* kNoDecimator = "none";

// In place of a method: every one of them, as a gene, with moving least squares and the ways to
// fill holes.
inline constexpr const char* kAutoMethod = "auto";
// The method whose vertices are points of the cloud: greedy projection.
inline constexpr const char* kInterpolatingMethod = "gp3";
// In place of a method: the bound's reference surface as it is, whatever made it. No P_R.
inline constexpr const char* kFitMethod = "fit";
// The method itself, but for kFitMethod with a decimator that knows no reference: the first of
// reconstruction_methods().
std::string method_for(const std::string& method, const std::string& decimator);
// In place of a decimator: both, as a gene.
inline constexpr const char* kAutoDecimator = "auto";

inline constexpr const char* kFillMethod = "fill.method";
// Its choices.
enum class FillMethod { kNone, kFlat, kSmooth };

// P_R of the method, hole filling, P_D of the decimator: the chromosome in the order of its genes
// (paper, section 3). With kAutoMethod and kAutoDecimator the own parameters of each have a meaning
// only with theirs; with kNoDecimator there is no P_D. Throws Error when there is no such method or
// decimator.
std::vector<ParameterSpec> chain_parameters(std::string_view method, std::string_view decimator);

// The candidate that values of chain_parameters(method, decimator) are: its method, its decimator
// and the values that have a meaning with them.
ChainSettings chain_settings(const std::string& method, const std::string& decimator,
                             const ParameterValues& values);

// What of a candidate must have a value. Throws Error when there is no such method or decimator.
std::vector<ParameterSpec> required_parameters(const ChainSettings& settings);

// The standard value of every parameter.
ParameterValues standard_values(std::span<const ParameterSpec> parameters);

}  // namespace emax
