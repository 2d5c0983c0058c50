// emax_lower: makes SystemVerilog, and OpenCL C, from a function of the kernel or of a given
// header.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "hls/lowering/designs.h"
#include "hls/lowering/lowering_program.h"

namespace {

constexpr std::string_view kFileHelp = R"(
       emax_lower HEADER --function FUNCTION [--folder FOLDER] [--scalar SCALAR]
                  [--record P,Q,...] [--stream] [OPTION...]

Lowers a function of one's own and compares the pipeline, simulated, with the function itself. The
files come into FOLDER (lowered/FUNCTION); --record adds a memory of records, which are the
parameters P, Q, ..., and --stream the pipeline between AXI4-Streams.
SCALAR is binary32, float:EXPONENT:MANTISSA, where MANTISSA is the number of bits that are stored
of it (float:5:10 is binary16, float:8:7 bfloat16), or fixed:WIDTH:FRACTION[:down][:wrap].)";

// The value that follows an option, which both are taken out of the arguments; empty if the option
// is not there, or is the last one.
std::string take_option(std::vector<std::string>& arguments, const char* option) {
  const auto at = std::find(arguments.begin(), arguments.end(), option);
  if (at == arguments.end() || at + 1 == arguments.end()) return {};
  std::string value = *(at + 1);
  arguments.erase(at, at + 2);
  return value;
}

int refuse(const std::string& message) {
  std::fprintf(stderr, "emax_lower: %s (emax_lower --help)\n", message.c_str());
  return 2;
}

// Becomes the script that compiles the function's header; returns only where that fails.
int lower_file(std::vector<std::string> arguments) {
  const std::string function = take_option(arguments, "--function");
  if (function.empty()) return refuse("--function needs a value");
  std::string folder = take_option(arguments, "--folder");
  if (folder.empty()) folder = "lowered/" + function;
  if (arguments.empty() || arguments[0].starts_with('-')) {
    return refuse("no header is given: emax_lower HEADER --function " + function);
  }
  std::vector<std::string> command = {EMAX_LOWER_SCRIPT, EMAX_BUILD, arguments[0], function,
                                      folder};
  command.insert(command.end(), arguments.begin() + 1, arguments.end());
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  execv(EMAX_LOWER_SCRIPT, words.data());
  std::fprintf(stderr, "emax_lower: %s: %s; it is part of emax's sources\n", EMAX_LOWER_SCRIPT,
               std::strerror(errno));
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool helps =
      std::ranges::count(arguments, "--help") + std::ranges::count(arguments, "-h") > 0;
  if (!helps && std::ranges::count(arguments, "--function") > 0) return lower_file(arguments);
  std::vector<emax::LoweringSubject> forms;
  for (const emax::Form form : emax::kForms) {
    forms.push_back({std::string(emax::info(form).name),
                     [form](const auto& options) { return emax::lower(form, options); }});
  }
  return emax::lowering_program(argc, argv, forms, kFileHelp);
}
