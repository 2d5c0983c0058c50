// The command line of a program that lowers: emax_lower, which has the kernel's forms, and programs
// with functions of one's own:
//
//   #include "hls/lowering/function_subject.h"
//   #include "my_function.h"
//
//   int main(int argc, char** argv) {
//     return emax::lowering_program(argc, argv, {EMAX_FUNCTION(my_function, "my_function.h")});
//   }
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hls/lowering/designs.h"

namespace emax {

struct LoweringSubject {
  std::string name;  // on the command line
  std::function<LoweredDesign(const LoweringOptions&)> lower;
};

// The exit code: 0, 1 if a file cannot be written, 2 for arguments that are not understood. Where
// there is one subject, its name need not be given. `other_usage` follows the first line of the
// help.
int lowering_program(int argc, char** argv, const std::vector<LoweringSubject>& subjects,
                     std::string_view other_usage = {});

}  // namespace emax
