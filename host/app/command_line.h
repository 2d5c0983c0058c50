#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string>

#include "host/app/commands.h"

namespace emax {

// What the command line gives: the options of every subcommand, and what to run.
struct CommandLine {
  OptimizeOptions optimize;
  DecimateOptions decimate;
  std::string decimate_bound = "two-sided";
  ErrorOptions error;
  VerifyOptions verify;
  std::string config_method = kFitMethod, config_decimator{Bounded::kName};
  std::function<int()> chosen;  // the exit code
};

// Adds the subcommands with their options. Both arguments outlive the parsing.
void add_commands(CLI::App& app, CommandLine& line);

// Where the subcommands write their JSON.
std::array<std::string*, 4> json_options(CommandLine& line);

}  // namespace emax
