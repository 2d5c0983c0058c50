#include "host/decimate/chain_parameters.h"

#include <array>

#include "host/reconstruct/reconstruction_parameters.h"
#include "sw_model/error.h"

namespace emax {
namespace {

using enum ParameterSpec::Kind;

const ParameterSpec& fill_size() {
  static const ParameterSpec spec = {
      "fill.size", kContinuous,
      0,           0.2,
      0.2,         "greatest hole to fill, its radius as a share of the width; 0 fills none"};
  return spec;
}

const std::vector<ParameterSpec>& schroeder() {
  static const std::vector<ParameterSpec> specs = {
      {"schroeder.reduction", kContinuous, 0, 0.98, 0.75, "share of the triangles to remove"},
      {"schroeder.feature_angle", kContinuous, 5, 90, 55,
       "angle between triangles from which their edge is a feature, in degrees"},
      {"schroeder.accumulate_error", kInteger, 0, 1, 1,
       "1: a vertex inherits the error of those removed around it; 0: errors are local"},
      {"schroeder.preserve_topology", kInteger, 0, 1, 1, "1: no splits, no holes closed"},
      {"schroeder.splitting", kInteger, 0, 1, 0, "1: the mesh may be split to go on"},
      {"schroeder.boundary_vertex_deletion", kInteger, 0, 1, 1, "1: boundary vertices may go"},
  };
  return specs;
}

const std::vector<ParameterSpec>& bounded() {
  static const std::vector<ParameterSpec> specs = {
      {"bounded.effort", kInteger, 0, 2, 1,
       "0: edge collapses; 1: then moves, turns and mended collapses; 2: until nothing is gained"},
      {"bounded.normal_cosine", kContinuous, -0.5, 0.9, 0.2,
       "least cosine between a triangle and the one that it replaces"},
      {"bounded.flatness", kContinuous, 1e-4, 0.1, 1e-3,
       "least height of a new triangle over its longest side"},
  };
  return specs;
}

}  // namespace

std::span<const std::string_view> decimators() {
  static constexpr std::array<std::string_view, 2> kDecimators = {"bounded", "schroeder"};
  return kDecimators;
}

std::span<const ParameterSpec> decimation_parameters(std::string_view decimator) {
  if (decimator == "bounded") return bounded();
  if (decimator == "schroeder") return schroeder();
  if (decimator == kNoDecimator) return {};
  throw Error("there is no decimator '" + std::string(decimator) +
              "'; choose bounded or schroeder");
}

std::vector<ParameterSpec> chain_parameters(std::string_view method, std::string_view decimator) {
  const auto reconstruction = reconstruction_parameters(method);
  const auto decimation = decimation_parameters(decimator);
  std::vector<ParameterSpec> chain(reconstruction.begin(), reconstruction.end());
  chain.push_back(fill_size());
  chain.insert(chain.end(), decimation.begin(), decimation.end());
  return chain;
}

namespace {

void add_values(const ChainSettings& settings, std::span<const ParameterSpec> specs,
                ParameterValues& values) {
  for (const ParameterSpec& spec : specs) {
    const auto value = settings.parameters.find(spec.name);
    if (value != settings.parameters.end()) values.insert(*value);
  }
}

}  // namespace

StageKey reconstruction_key(const ChainSettings& settings) {
  StageKey key{settings.method, {}};
  add_values(settings, reconstruction_parameters(settings.method), key.second);
  return key;
}

StageKey surface_key(const ChainSettings& settings) {
  StageKey key = reconstruction_key(settings);
  add_values(settings, {&fill_size(), 1}, key.second);
  return key;
}

ParameterValues standard_values(std::span<const ParameterSpec> parameters) {
  ParameterValues values;
  for (const ParameterSpec& spec : parameters) values[spec.name] = spec.standard;
  return values;
}

}  // namespace emax
