#include "host/parameters/chain_parameters.h"

#include <algorithm>
#include <array>

#include "host/parameters/reconstruction_parameters.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using enum ParameterSpec::Kind;

constexpr const char* kMethod = "method";
constexpr const char* kDecimator = "decimator";

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
      {kBoundedEffort,
       kInteger,
       0,
       kDeepEffort,
       2,
       "0: edge collapses far below the bound; 1: and the others; 2: and relocations, edge flips "
       "and mended "
       "collapses; 3: these until nothing is gained",
       {},
       std::nullopt,
       false},
      {"bounded.normal_cosine", kContinuous, -0.5, 0.9, 0.2,
       "least cosine between a triangle and the one that it replaces"},
      {"bounded.flatness", kContinuous, 1e-4, 0.01, 1e-3,
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

namespace {

ParameterSpec categories_of(const char* name, const char* meaning,
                            std::span<const std::string_view> choices) {
  return {name,
          kCategorical,
          0,
          static_cast<double>(choices.size() - 1),
          0,
          meaning,
          {choices.begin(), choices.end()}};
}

const std::vector<ParameterSpec>& automatic() {
  static const std::vector<ParameterSpec> specs = [] {
    const auto methods = reconstruction_methods();
    std::vector<ParameterSpec> all = {categories_of(kMethod, "reconstruction", methods)};
    const auto mls = mls_parameters();
    all.insert(all.end(), mls.begin(), mls.end());
    for (std::size_t m = 0; m < methods.size(); ++m) {
      for (const ParameterSpec& spec : reconstruction_parameters(methods[m])) {
        const bool own = spec.name.starts_with(methods[m]);
        const bool known = std::ranges::count(all, spec.name, &ParameterSpec::name) > 0;
        if (!known) all.push_back(spec);  // the first method's standard, where they share it
        if (own) all.back().only_with = {kMethod, static_cast<double>(m)};
      }
    }
    all.push_back(
        {kFillMethod,
         kCategorical,
         0,
         2,
         1,
         "what is done about holes",
         {"none is filled", "filled", "filled with new vertices by moving least squares"}});
    all.push_back(fill_size());
    all.back().only_with = {kFillMethod, static_cast<double>(FillMethod::kNone), true};
    return all;
  }();
  return specs;
}

}  // namespace

std::string method_for(const std::string& method, const std::string& decimator) {
  const bool unknown = method == kFitMethod && decimator != "bounded";
  return unknown ? std::string(reconstruction_methods().front()) : method;
}

std::vector<ParameterSpec> chain_parameters(std::string_view method, std::string_view decimator) {
  std::vector<ParameterSpec> chain;
  if (method == kAutoMethod) {
    chain = automatic();
  } else if (method != kFitMethod) {
    const auto reconstruction = reconstruction_parameters(method);
    chain.assign(reconstruction.begin(), reconstruction.end());
    chain.push_back(fill_size());
  }
  if (decimator != kAutoDecimator) {
    const auto decimation = decimation_parameters(decimator);
    chain.insert(chain.end(), decimation.begin(), decimation.end());
    return chain;
  }
  const auto all = decimators();
  chain.push_back(categories_of(kDecimator, "decimation", all));
  for (std::size_t d = 0; d < all.size(); ++d) {
    for (const ParameterSpec& spec : decimation_parameters(all[d])) {
      chain.push_back(spec);
      chain.back().only_with = {kDecimator, static_cast<double>(d)};
    }
  }
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

ParameterValues cloud_key(const ChainSettings& settings) {
  ParameterValues values;
  add_values(settings, mls_parameters(), values);
  return values;
}

StageKey reconstruction_key(const ChainSettings& settings) {
  StageKey key{settings.method, cloud_key(settings)};
  if (settings.method == kFitMethod) return key;
  add_values(settings, reconstruction_parameters(settings.method), key.second);
  return key;
}

StageKey surface_key(const ChainSettings& settings) {
  StageKey key = reconstruction_key(settings);
  for (const std::string& name : {std::string(kFillMethod), fill_size().name}) {
    const auto value = settings.parameters.find(name);
    if (value != settings.parameters.end()) key.second.insert(*value);
  }
  return key;
}

ChainSettings chain_settings(const std::string& method, const std::string& decimator,
                             const ParameterValues& values) {
  ChainSettings settings{method, decimator, values};
  if (method != kAutoMethod && decimator != kAutoDecimator) return settings;
  for (const ParameterSpec& spec : chain_parameters(method, decimator)) {
    if (!spec.only_with) continue;
    const auto& [other, category, unless] = *spec.only_with;
    if ((values.at(other) == category) == unless) settings.parameters.erase(spec.name);
  }
  const auto choose = [&](const char* gene, std::span<const std::string_view> choices) {
    settings.parameters.erase(gene);
    return std::string(choices[static_cast<std::size_t>(values.at(gene))]);
  };
  if (method == kAutoMethod) settings.method = choose(kMethod, reconstruction_methods());
  if (decimator == kAutoDecimator) settings.decimator = choose(kDecimator, decimators());
  return settings;
}

std::vector<ParameterSpec> required_parameters(const ChainSettings& settings) {
  std::vector<ParameterSpec> required = chain_parameters(settings.method, settings.decimator);
  const auto category = [&](const char* name, double otherwise) {
    const auto value = settings.parameters.find(name);
    return value == settings.parameters.end() ? otherwise : value->second;
  };
  if (category(kFillMethod, 1) == static_cast<double>(FillMethod::kNone)) {
    std::erase_if(required,
                  [](const ParameterSpec& spec) { return spec.name == fill_size().name; });
  }
  const double mls = category("mls.method", 0);
  for (const ParameterSpec& spec : mls_parameters()) {
    if (spec.only_with && (mls == spec.only_with->category) != spec.only_with->unless) {
      required.push_back(spec);
    }
  }
  return required;
}

ParameterValues standard_values(std::span<const ParameterSpec> parameters) {
  ParameterValues values;
  for (const ParameterSpec& spec : parameters) values[spec.name] = spec.standard;
  return values;
}

}  // namespace emax
