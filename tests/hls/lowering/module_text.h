// A generated module's text, taken apart: what is declared, and what drives what.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace emax::test {

struct ModuleText {
  std::string name;
  // As often as they are declared.
  std::vector<std::string> inputs, outputs, signals, parameters, instances;
  std::map<std::string, int> drivers;  // by signal or output
  std::vector<std::string> used;       // every name in an expression or connection
};
ModuleText module_text(const std::string& text);

// The brute force over a module's text. Every identifier is legal, no keyword, and declared once;
// every one that is used is declared; every signal and output has one driver, nothing else has any.
// Returns what is wrong; empty if nothing is.
std::string fault_of_module(const std::string& text);

}  // namespace emax::test
