// Names that SystemVerilog takes, and a table that gives each name once.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

namespace emax {

// A letter or _, then letters, digits and _.
bool is_identifier(std::string_view text);

// The keywords of IEEE 1800-2017, annex B, in alphabetical order.
std::span<const std::string_view> keywords();
bool is_keyword(std::string_view word);

// Words that no generated identifier may be: the keywords, and the words of C++ and SystemC for
// which Verilator warns when a port has their name.
bool is_reserved_word(std::string_view word);

// The modules below the generated ones, which no generated module may redefine.
std::span<const std::string_view> used_modules();

// Throws std::invalid_argument, with what is permitted, for a name that a generated module cannot
// have: no identifier, a keyword, or one of used_modules().
void check_module_name(const std::string& name);

// The names of one generated module. It begins with the module's own name, which simulators give to
// the instance at the top, and with those that the generator itself writes into modules of every
// kind (ports, parameters, modules that it instantiates).
class Identifiers {
 public:
  explicit Identifiers(const std::string& module);

  // A legal name that was not given before: `wanted` where it is legal and free, else the first
  // free one of wanted_2, wanted_3 and so on. A reserved word gets the ending _value; characters
  // that an identifier cannot have become _.
  std::string take(std::string_view wanted);

 private:
  std::set<std::string, std::less<>> taken_;
};

}  // namespace emax
