#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace emax {

// The words of the command line after the program's name, in the parser's form: "-o=x" becomes "-o"
// and "x". Throws Error for a word that is not UTF-8, and for a command or an option that does not
// exist; the error suggests the closest one, if one is close enough.
std::vector<std::string> checked_words(const CLI::App& app, std::span<char* const> words);

// The candidate closest to a misspelt `word`, the first if several are equally close. Empty if none
// is close: at most a third of the word's characters (or one) may be inserted, left out, replaced
// or exchanged with a neighbour. A candidate that begins with the word is one such step away.
std::string closest(std::string_view word, std::span<const std::string> candidates);

// Number of such steps from `a` to `b` (optimal string alignment). O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace emax
