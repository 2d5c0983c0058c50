#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string>

#include "host/app/commands.h"

namespace emax {

// The parsed command line: the options of every subcommand, and the function to run.
struct CommandLine {
  OptimizeOptions optimize;
  ReconstructOptions reconstruct;
  DecimateOptions decimate;
  std::string decimate_bound = "two-sided";
  ErrorOptions error;
  VerifyOptions verify;
  InfoOptions info;
  FeaturesOptions features;
  std::string shell;
  std::string config_method = kFitMethod, config_decimator{Bounded::kName},
              config_features{kNoFeatures};
  bool quiet = false;
  std::string progress;         // a ProgressStyle; empty: text, or none with `quiet`
  std::function<int()> chosen;  // the exit code
};

// Adds the subcommands with their options. Both arguments must outlive the parsing.
void add_commands(CLI::App& app, CommandLine& line);

// The --json options of the subcommands.
std::array<std::string*, 7> json_options(CommandLine& line);

}  // namespace emax
