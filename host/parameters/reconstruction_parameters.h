#pragma once

#include <span>
#include <string_view>

#include "host/parameters/parameter_spec.h"

namespace emax {

// The reconstruction methods of the paper's section 2.1: "gp3", "poisson", "hoppe".
std::span<const std::string_view> reconstruction_methods();

// Moving least squares of the cloud before a method; without values for them there are none.
std::span<const ParameterSpec> mls_parameters();

// P_R of a method with domains and standards. Needs no PCL.
// Throws Error when there is no such method.
std::span<const ParameterSpec> reconstruction_parameters(std::string_view method);

// PCL's Poisson corrupts memory when a process runs it twice: a process that has run such a method
// must not reconstruct again.
bool single_use(std::string_view method);

}  // namespace emax
