// The registry (registry.h) as tables, for whoever treats all methods and decimators alike.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/parameters/registry.h"

namespace emax {

struct MethodDescription {
  std::string name;
  Parameters parameters;    // P_R
  std::string_view remedy;  // where no triangle comes out
  bool interpolates;        // its vertices are points of the cloud
  bool single_use;          // a process that has run it must not reconstruct again
  bool searched;            // one of those that a search chooses from
};

struct DecimatorDescription {
  std::string name;
  std::string_view meaning;   // for the help of --decimator
  Parameters parameters;      // P_D
  bool bounded;               // keeps the bound that a run fixes before its search
  std::string_view monotone;  // the parameter along which triangles fall and e_max rises, or empty
};

template <typename... Method>
std::vector<MethodDescription> descriptions_of(TypeList<Method...>) {
  return {{std::string(Method::kName), Method::parameters(), Method::kRemedy, Method::kInterpolates,
           Method::kSingleUse, Method::kSearched}...};
}

template <typename... Decimator>
std::vector<DecimatorDescription> decimator_descriptions_of(TypeList<Decimator...>) {
  return {{std::string(Decimator::kName), Decimator::kMeaning, Decimator::parameters(),
           Decimator::kBounded, Decimator::kMonotone}...};
}

// In the order of the registry.
std::span<const MethodDescription> reconstruction_methods();
std::span<const DecimatorDescription> decimators();
// Of the methods, those that a search chooses from.
std::vector<MethodDescription> searched_methods();

// Throw Error, which lists the names, when there is no such method or decimator.
const MethodDescription& method_named(std::string_view name);
const DecimatorDescription& decimator_named(std::string_view name);
// The same, but nullptr.
const MethodDescription* find_method(std::string_view name);

template <typename Description>
std::vector<std::string> names_of(std::span<const Description> descriptions) {
  std::vector<std::string> names;
  for (const Description& d : descriptions) names.push_back(d.name);
  return names;
}

// Of the decimators that are bounded, or of the others.
std::vector<std::string> names_of_decimators(bool bounded);

// "gp3, poisson or auto"
std::string alternatives(std::span<const std::string> names);

}  // namespace emax
