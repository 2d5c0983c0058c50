#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// A fuzz target is one source in tests/fuzz/targets/ that defines the two functions below; main.cpp
// makes a libFuzzer program of it.
namespace emax::fuzz {

using Input = std::span<const std::uint8_t>;

// Gives the input to a reader. An Error of one line is the reader's right. Everything else that is
// thrown, a report of a sanitizer and a broken require() are finds.
void read(Input input);

// Inputs to begin with. The reader accepts each of them.
std::vector<std::string> seeds();

// Ends the program where something does not hold that must, so that libFuzzer keeps the input.
void require(bool holds, std::string_view what);

Input bytes_of(std::string_view text);

}  // namespace emax::fuzz
