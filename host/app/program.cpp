#include "host/app/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/app/command_line.h"
#include "host/app/command_words.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/progress_style.h"
#include "host/app/standard_streams.h"
#include "sw_model/base/error.h"
#include "sw_model/model/self_test.h"

namespace emax {
namespace {

int run(int argc, char** argv, const Machines& machines) {
  CLI::App app(
      "emax: a triangle mesh with as few triangles as possible, certified to lie within a "
      "tolerance of every point of a scan.");
  app.name("emax");
  app.set_version_flag("--version", "emax " EMAX_VERSION);
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* all, const CLI::Error& error) {
    const auto chosen = all->get_subcommands();
    return fmt::format("emax: {}; see emax {}--help\n", error.what(),
                       chosen.empty() ? "" : chosen.front()->get_name() + " ");
  });
  CommandLine line;
  line.optimize.machines = line.reconstruct.machines = line.decimate.machines = machines;
  line.error.machines = line.verify.machines = machines;
  add_commands(app, line);
  std::vector<std::string> words =
      checked_words(app, std::span(argv, static_cast<std::size_t>(argc)));
  if (argc == 1) {
    to_standard_error(app.help());
    return kExitError;
  }
  try {
    std::ranges::reverse(words);  // the order that the parser expects
    app.parse(std::move(words));
  } catch (const CLI::ParseError& parse_error) {
    return app.exit(parse_error) == 0 ? kExitOk : kExitError;
  }
  for (std::string* json : json_options(line)) direct_json(*json);
  if (line.quiet) silence_standard_output();
  const std::string style = line.quiet ? "none" : "text";
  set_progress_style(progress_style_named(line.progress.empty() ? style : line.progress));
  verify_arithmetic();
  if (!app.got_subcommand("verify")) note_interrupts();  // verify leaves nothing unfinished
  return line.chosen();
}

}  // namespace

int run_program(int argc, char** argv, const Machines& machines) {
  open_standard_streams();
  const auto complain = [](const std::string& text) { to_standard_error("emax: " + text + "\n"); };
  int code = kExitError;
  try {
    code = run(argc, argv, machines);
  } catch (const Error& error) {
    complain(error.what());
  } catch (const Interrupted&) {
    complain("interrupted; nothing was written");
    code = kExitInterrupted;
  } catch (const std::bad_alloc&) {
    complain("out of memory; use a smaller cloud or fewer --jobs");
  } catch (const std::system_error& error) {
    complain(error.what());
  } catch (const std::exception& error) {
    complain(std::string(error.what()) + " (a defect of the program; please report it)");
  }
  // If standard output takes the JSON, the text that is flushed here goes to standard error.
  if (std::fflush(stdout) != 0 && !standard_output_is_json()) {
    complain(std::string("standard output cannot be written: ") + std::strerror(errno));
    return kExitError;
  }
  return code;
}

}  // namespace emax
