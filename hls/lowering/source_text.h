// Small questions about the text of C++ sources.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace emax {

// The text with comments replaced by blanks, so that offsets stay.
std::string without_comments(std::string_view text);

// The commas in [begin, end) outside of brackets; angle brackets are not counted.
std::vector<std::size_t> commas(std::string_view code, std::size_t begin, std::size_t end);

// The last identifier of the text; empty if there is none.
std::string last_word(std::string_view code);

// The source of a header of the kernel as it was when this library was built; of any other file as
// it is now. Empty if it cannot be read. The text stays until the program ends.
std::string_view source_text(std::string_view path);

}  // namespace emax
