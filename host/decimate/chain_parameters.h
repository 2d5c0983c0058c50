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

// One candidate's way through the chain.
struct ChainSettings {
  std::string method;     // one of reconstruction_methods()
  std::string decimator;  // one of decimators()
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
};

struct ChainResult {
  TriangleMesh mesh;
  std::size_t reconstruction_triangles = 0;  // before filling and decimation
  std::size_t unmeshed_points = 0;           // see Reconstruction
  // Of the bounded decimator under a two-sided bound: how far the mesh strays from the reference,
  // certified; more than epsilon_back exactly where it breaks the bound.
  double back_distance = 0;
  StageSeconds seconds;
};

// What a stage's result depends on: the method and the values of its genes and of those before it.
using StageKey = std::pair<std::string, ParameterValues>;
StageKey reconstruction_key(const ChainSettings& settings);
StageKey surface_key(const ChainSettings& settings);  // its holes filled

std::span<const std::string_view> decimators();

// P_D of a decimator with domains and standards. Throws Error when there is no such decimator.
std::span<const ParameterSpec> decimation_parameters(std::string_view decimator);

// In place of a decimator: the chain ends with the surface, its holes filled.
inline constexpr const char* kNoDecimator = "none";

// P_R of the method, hole filling, P_D of the decimator: the chromosome in the order of its genes
// (paper, section 3). Throws Error when there is no such method or decimator. With
// kNoDecimator there is no P_D.
std::vector<ParameterSpec> chain_parameters(std::string_view method, std::string_view decimator);

// The standard value of every parameter.
ParameterValues standard_values(std::span<const ParameterSpec> parameters);

}  // namespace emax
