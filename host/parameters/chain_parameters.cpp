#include "host/parameters/chain_parameters.h"

#include <algorithm>

#include "host/parameters/descriptions.h"

namespace emax {
namespace {

constexpr const char* kMethod = "method";
constexpr const char* kDecimator = "decimator";

Parameter choice(const char* name, const char* meaning, std::vector<std::string> names) {
  Parameter p;
  p.name = name;
  p.kind = Gene::Kind::kCategorical;
  p.upper = static_cast<double>(names.size() - 1);
  p.meaning = meaning;
  p.categories = std::move(names);
  return p;
}

// Their conditions hold positions in the longer list then.
void append(Parameters& all, Parameters more) {
  const std::size_t offset = all.size();
  for (Parameter& p : more) {
    if (p.only_with) p.only_with->gene += offset;
    all.push_back(std::move(p));
  }
}

// Every method as a gene, with the parameters of each, moving least squares and ways to fill holes.
Parameters automatic() {
  const std::vector<MethodDescription> methods = searched_methods();
  Parameters all = {
      choice(kMethod, "reconstruction", names_of(std::span<const MethodDescription>(methods)))};
  append(all, Mls::parameters());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    for (const Parameter& p : methods[m].parameters) {
      const bool own = p.name.starts_with(methods[m].name + '.');
      const bool known = std::ranges::count(all, p.name, &Parameter::name) > 0;
      if (!known) all.push_back(p);  // the first method's standard, where they share it
      if (own) all.back().only_with = {0, static_cast<double>(m)};
    }
  }
  append(all, Fill::parameters());
  return all;
}

}  // namespace

bool takes_bound(std::string_view decimator) {
  if (decimator == kNoDecimator) return true;
  if (decimator != kAutoDecimator) return decimator_named(decimator).bounded;
  return std::ranges::any_of(decimators(), &DecimatorDescription::bounded);
}

bool keeps_bound(std::string_view decimator) {
  if (decimator == kNoDecimator) return false;
  if (decimator != kAutoDecimator) return decimator_named(decimator).bounded;
  return std::ranges::all_of(decimators(), &DecimatorDescription::bounded);
}

std::string method_for(const std::string& method, const std::string& decimator) {
  const MethodDescription* const named = find_method(method);
  if (!keeps_bound(decimator)) {
    return method == kFitMethod ? reconstruction_methods().front().name : method;
  }
  return named && !named->searched ? kFitMethod : method;
}

namespace {

Parameters without_features(std::string_view method, std::string_view decimator) {
  Parameters chain;
  if (method == kAutoMethod) {
    chain = automatic();
  } else if (method != kFitMethod) {
    chain = method_named(method).parameters;
    append(chain, parameters_of(Fill::kSize));
  }
  if (decimator == kNoDecimator) return chain;
  if (decimator != kAutoDecimator) {
    append(chain, decimator_named(decimator).parameters);
    return chain;
  }
  const auto all = decimators();
  const std::size_t chosen = chain.size();
  chain.push_back(choice(kDecimator, "decimation", names_of(all)));
  for (std::size_t d = 0; d < all.size(); ++d) {
    for (const Parameter& p : all[d].parameters) {
      chain.push_back(p);
      chain.back().only_with = {chosen, static_cast<double>(d)};
    }
  }
  return chain;
}

Parameters features_of(std::string_view features) {
  if (features == kNoFeatures) return {};
  using Method = PlaneFeatures::Method;
  const auto followed =
      static_cast<double>(features == kAllFeatures ? Method::kAll : Method::kPlanes);
  Parameters all = PlaneFeatures::parameters();
  Parameter& method = all.front();
  // Curved shapes cost triangles, so no search takes them up.
  method.upper = followed;
  method.categories.resize(static_cast<std::size_t>(followed) + 1);
  // Of as many triangles those on planes, which come first, are the result.
  method.standard = followed;
  if (features == kAutoFeatures) return all;
  method.fixed = followed;
  // Planes are asked for, so edges count more than triangles.
  all.back().standard = 0;
  all.back().fixed = 0;
  return all;
}

void add_values(const ChainSettings& settings, std::span<const Parameter> parameters,
                ParameterValues& values) {
  const auto& all = settings.parameters.by_name();
  for (const Parameter& p : parameters) {
    const auto value = all.find(p.name);
    if (value != all.end()) values.by_name().insert(*value);
  }
}

}  // namespace

Parameters chain_parameters(std::string_view method, std::string_view decimator,
                            std::string_view features) {
  Parameters chain = without_features(method, decimator);
  append(chain, features_of(features));
  return chain;
}

ParameterValues cloud_key(const ChainSettings& settings) {
  ParameterValues values;
  add_values(settings, Mls::parameters(), values);
  return values;
}

StageKey reconstruction_key(const ChainSettings& settings) {
  StageKey key{settings.method, cloud_key(settings)};
  if (settings.method == kFitMethod) return key;
  add_values(settings, method_named(settings.method).parameters, key.second);
  return key;
}

StageKey surface_key(const ChainSettings& settings) {
  StageKey key = reconstruction_key(settings);
  add_values(settings, Fill::parameters(), key.second);
  return key;
}

ChainSettings chain_settings(const std::string& method, const std::string& decimator,
                             const ParameterValues& values) {
  ChainSettings settings{method, decimator, values};
  if (PlaneFeatures::method(values) == PlaneFeatures::Method::kNone) {
    for (const Parameter& p : PlaneFeatures::parameters()) {
      settings.parameters.by_name().erase(p.name);
    }
  }
  if (method != kAutoMethod && decimator != kAutoDecimator) return settings;
  auto& kept = settings.parameters.by_name();
  const Parameters chain = chain_parameters(method, decimator);
  for (const Parameter& p : chain) {
    if (!p.only_with) continue;
    const double value = values.by_name().at(chain[p.only_with->gene].name);
    if (!p.only_with->holds(value)) kept.erase(p.name);
  }
  const auto choose = [&](const char* gene, const auto& choices) {
    kept.erase(gene);
    return choices[static_cast<std::size_t>(values.by_name().at(gene))].name;
  };
  if (method == kAutoMethod) settings.method = choose(kMethod, searched_methods());
  if (decimator == kAutoDecimator) settings.decimator = choose(kDecimator, decimators());
  return settings;
}

ParameterValues features_key(const ChainSettings& settings) {
  ParameterValues values;
  if (PlaneFeatures::method(settings.parameters) == PlaneFeatures::Method::kNone) return values;
  add_values(settings, PlaneFeatures::parameters(), values);
  values.by_name().erase(std::string(PlaneFeatures::kSpread.name));
  return values;
}

void require_values(const ChainSettings& settings) {
  const ParameterValues& values = settings.parameters;
  Parameters required = chain_parameters(settings.method, settings.decimator);
  if (Fill::method(values) == Fill::Method::kNone) {
    std::erase_if(required, [](const Parameter& p) { return p.name == Fill::kSize.name; });
  }
  const auto mls = static_cast<double>(Mls::method(values));
  for (Parameter& p : Mls::parameters()) {
    if (p.only_with && p.only_with->holds(mls)) required.push_back(std::move(p));
  }
  if (PlaneFeatures::method(values) != PlaneFeatures::Method::kNone) {
    append(required, PlaneFeatures::parameters());
  }
  values.require(required);
}

}  // namespace emax
