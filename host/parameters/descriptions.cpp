#include "host/parameters/descriptions.h"

#include <algorithm>
#include <iterator>

#include "sw_model/base/error.h"

namespace emax {

const MethodDescription* find_method(std::string_view name) {
  const auto methods = reconstruction_methods();
  const auto found = std::ranges::find(methods, name, &MethodDescription::name);
  return found == methods.end() ? nullptr : &*found;
}

const MethodDescription& method_named(std::string_view name) {
  if (const MethodDescription* found = find_method(name)) return *found;
  std::vector<std::string> choices = names_of(reconstruction_methods());
  choices.emplace_back("auto");
  throw Error("there is no reconstruction method '" + std::string(name) + "'; choose " +
              alternatives(choices));
}

std::vector<MethodDescription> searched_methods() {
  const auto methods = reconstruction_methods();
  std::vector<MethodDescription> searched;
  std::ranges::copy_if(methods, std::back_inserter(searched), &MethodDescription::searched);
  return searched;
}

const DecimatorDescription& decimator_named(std::string_view name) {
  const auto all = decimators();
  const auto found = std::ranges::find(all, name, &DecimatorDescription::name);
  if (found != all.end()) return *found;
  throw Error("there is no decimator '" + std::string(name) + "'; choose " +
              alternatives(names_of(all)));
}

std::vector<std::string> names_of_decimators(bool bounded) {
  std::vector<std::string> names;
  for (const DecimatorDescription& d : decimators()) {
    if (d.bounded == bounded) names.push_back(d.name);
  }
  return names;
}

std::string alternatives(std::span<const std::string> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

}  // namespace emax
