#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
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

struct ChainResult {
  TriangleMesh mesh;
  std::size_t reconstruction_triangles = 0;  // before filling and decimation
  std::size_t unmeshed_points = 0;           // see Reconstruction
};

std::span<const std::string_view> decimators();

// P_D of a decimator with domains and standards. Throws Error when there is no such decimator.
std::span<const ParameterSpec> decimation_parameters(std::string_view decimator);

// P_R of the method, hole filling, P_D of the decimator: the chromosome in the order of its genes
// (paper, section 3). Throws Error when there is no such method or decimator.
std::vector<ParameterSpec> chain_parameters(std::string_view method, std::string_view decimator);

// The standard value of every parameter.
ParameterValues standard_values(std::span<const ParameterSpec> parameters);

}  // namespace emax
