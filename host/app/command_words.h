#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace emax {

// The words of the command line behind the program's name, as the parser takes them: "-o=x" as "-o"
// and "x". Throws Error for a word that is not UTF-8, and for a command or an option that does not
// exist, with the one that was meant where that can be told.
std::vector<std::string> checked_words(const CLI::App& app, std::span<char* const> words);

// The candidate closest to a misspelt `word`; empty where none is close, which is at most a third
// of its characters (or one) inserted, left out, replaced or exchanged with a neighbour; one that
// begins with the word is one such step away. The first of several equally close ones.
std::string closest(std::string_view word, std::span<const std::string> candidates);

// How many such steps lead from `a` to `b` (optimal string alignment). O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace emax
