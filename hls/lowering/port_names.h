#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace emax {

struct PortNames {
  std::vector<std::string> inputs, outputs;
  std::vector<std::string> parameters;    // of the function
  std::vector<std::size_t> parameter_of;  // for each input, its place in `parameters`
};

// The names of a function's scalars, from the text that defines it and the structs that it takes
// and returns: `p_x` for the field x of the parameter p, `t` for the field t of the result, the
// function's own name for a result that is a scalar. A type whose struct is not in the text, or
// among the kernel's vectors, is a scalar. Throws std::invalid_argument if the function is not
// defined there.
PortNames port_names(std::string_view text, std::string_view function);

}  // namespace emax
