#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

namespace emax {

// The script that completes the program's commands, options and choices in a shell: "bash", "zsh"
// or "fish". Other words are completed as files.
std::string completion_script(const CLI::App& app, std::string_view shell);

}  // namespace emax
