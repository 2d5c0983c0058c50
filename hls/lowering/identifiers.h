// Names that SystemVerilog permits, and a table that gives each name only once.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

namespace emax {

bool is_word(char c);  // a letter, a digit or _

// A letter or _, then letters, digits and _.
bool is_identifier(std::string_view text);

// The keywords of IEEE 1800-2017, annex B, in alphabetical order.
std::span<const std::string_view> keywords();
bool is_keyword(std::string_view word);

// Words that no generated identifier may be: the keywords, and words of C++ and SystemC, for which
// Verilator warns if a port has such a name.
bool is_reserved_word(std::string_view word);

// The modules below the generated ones, which no generated module may redefine.
std::span<const std::string_view> used_modules();

// Throws std::invalid_argument for a name that a generated module cannot have: not an identifier, a
// keyword, or one of used_modules(). The message gives the permitted form.
void check_module_name(const std::string& name);

// The names of one generated module. The table begins with the module's own name, which simulators
// give to the instance at the top, and with the names that the generator writes into every module
// (ports, parameters, instantiated modules).
class Identifiers {
 public:
  explicit Identifiers(const std::string& module);

  // A legal name that was not given before: `wanted` if it is legal and free, else the first free
  // one of wanted_2, wanted_3 and so on. A reserved word gets the suffix _value. Characters that an
  // identifier cannot have become _.
  std::string take(std::string_view wanted);

 private:
  std::set<std::string, std::less<>> taken_;
};

}  // namespace emax
