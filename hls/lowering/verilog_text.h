// The text forms of lines of generated SystemVerilog.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hls/lowering/designs.h"

namespace emax {

constexpr std::size_t kLineLength = 100;

// The file's first line.
std::string generated_line(const LoweredDesign& design);

// "[31:0] "; nothing for a single bit.
std::string vector_type(int bits);

// `word` with a digit for every four of the bits, upper or lower case.
std::string hexadecimal(std::uint64_t word, int bits, bool upper);

// Items separated by commas, on as many lines as needed; later lines begin with `indent`.
std::string listed(const std::string& head, const std::string& indent,
                   const std::vector<std::string>& items, const std::string& end);

// "  logic [31:0] a, b;"; nothing if there are no names.
std::string declarations(const std::string& type, const std::vector<std::string>& names);

// An instance with its connections on the same line, or on a second one if they do not fit.
std::string instance(const std::string& module_and_parameters, const std::string& name,
                     const std::string& connections);

// A delay line of `cycles` for `bits`, written as `width`; its instance is `name`, it drives `to`.
std::string delay_line(int bits, const std::string& width, int cycles, const DelayStyles& styles,
                       const std::string& name, const std::string& from, const std::string& to);

// The name of a value delayed to a cycle, unless another name takes its place (identifiers.h).
std::string at_cycle(const std::string& name, int cycle);

}  // namespace emax
