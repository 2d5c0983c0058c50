#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/genocop/settings.h"
#include "host/parameters/parameter.h"

namespace emax {

struct Config {
  Settings search;
  Parameters genes;  // with the domain as configured, within the parameter's own
  std::vector<LinearConstraint> linear;  // by position in genes

  bool operator==(const Config&) const = default;
};

Config default_config(std::span<const Parameter> parameters);

// The default as a commented TOML file; read_config of it gives default_config again.
std::string default_config_text(std::span<const Parameter> parameters);

// Keys that are absent keep their default. Throws Error, with file and line, for an unknown key or
// gene, a wrong type, a value out of its domain, and a start that breaks a linear constraint.
Config read_config(const std::filesystem::path& path, std::span<const Parameter> parameters);

// Every value of it by name, as text that tells any two apart: what a run's folder holds.
std::vector<std::pair<std::string, std::string>> named_values(const Config& config);

// The search space; the standard values are its start, then these with each other category.
// monotone_gene: a name, or empty for none; a name that is not among the genes, or is fixed, counts
// as none.
Problem make_problem(const Config& config, std::string_view monotone_gene);

}  // namespace emax
