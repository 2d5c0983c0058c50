#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <emax/genocop.h>
#include "host/genocop/settings.h"
#include "host/parameters/parameter_spec.h"

namespace emax {

// What the search may do with one parameter.
struct GeneConfig {
  Gene gene;  // lower and upper as configured, within the parameter's own domain
  double standard = 0;
  std::optional<double> fixed;  // not searched: always this value

  bool operator==(const GeneConfig&) const = default;
};

struct Config {
  Settings search;
  std::vector<GeneConfig> genes;         // in the order of the parameters
  std::vector<LinearConstraint> linear;  // by position in genes

  bool operator==(const Config&) const = default;
};

Config default_config(std::span<const ParameterSpec> parameters);

// The default as a commented TOML file; read_config of it gives default_config again.
std::string default_config_text(std::span<const ParameterSpec> parameters);

// Keys that are absent keep their default. Throws Error, with file and line, for an unknown key or
// gene, a wrong type, a value out of its domain, and a start that breaks a linear constraint.
Config read_config(const std::filesystem::path& path, std::span<const ParameterSpec> parameters);

// Every value of it by name, as text that tells any two apart: what a run's folder holds.
std::vector<std::pair<std::string, std::string>> named_values(const Config& config);

// The search space; the standard values are its start, then these with each other category.
// monotone_gene: a name, or empty for none; a name that is not among the genes, or is fixed, counts
// as none.
Problem make_problem(const Config& config, std::string_view monotone_gene);

}  // namespace emax
