#include "host/parameters/parameter.h"

#include "sw_model/base/error.h"

namespace emax {

double ParameterValues::value(std::string_view name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) {
    throw Error("the parameter " + std::string(name) + " has no value");
  }
  return found->second;
}

void ParameterValues::require(std::span<const Parameter> parameters) const {
  for (const Parameter& parameter : parameters) value(parameter.name);
}

}  // namespace emax
