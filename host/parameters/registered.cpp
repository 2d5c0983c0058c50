#include "host/parameters/descriptions.h"

// Nothing but the registry's tables, so that a test can link tables of its own in their place.
namespace emax {

std::span<const MethodDescription> reconstruction_methods() {
  static const std::vector<MethodDescription> all = descriptions_of(ReconstructionMethods{});
  return all;
}

std::span<const DecimatorDescription> decimators() {
  static const std::vector<DecimatorDescription> all = decimator_descriptions_of(Decimators{});
  return all;
}

}  // namespace emax
