#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <new>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/app/command_words.h"
#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/option_checks.h"
#include "host/app/standard_streams.h"
#include "host/block_search/block_search.h"
#include "host/config/config.h"
#include "host/device/device_address.h"
#include "host/files/input_file.h"
#include "host/parameters/chain_parameters.h"
#include "sw_model/base/error.h"
#include "sw_model/model/self_test.h"

namespace emax {
namespace {

void add_json(CLI::App& command, std::string& json) {
  command.add_option("--json", json,
                     "also write the result to this file, or with - to standard output; the text "
                     "then goes to standard error");
}

void add_points_and_json(CLI::App& command, std::string& excluded_share, bool& skip_invalid,
                         std::string& json) {
  add_json(command, json);
  command
      .add_option("--exclude-outliers", excluded_share,
                  "share of the points (N or N%) that may lie farther than the tolerance; the "
                  "certificate lists them")
      ->capture_default_str();
  command.add_flag("--skip-invalid", skip_invalid,
                   "leave out points with NaN or infinite coordinates");
}

void add_common(CLI::App& command, CommonOptions& options) {
  command
      .add_option("CLOUD", options.cloud, "point cloud: .ply .pcd .xyz .asc .txt .pts .obj .off")
      ->required();
  command.add_option("--device", options.device, "who evaluates the kernel: " + device_help())
      ->capture_default_str();
  add_points_and_json(command, options.excluded_share, options.skip_invalid, options.json);
  command.add_flag("--brute-force", options.brute_force,
                   "compare every point with every triangle: slow, with the same result");
}

constexpr const char* kClosedHelp =
    "close every hole, so that the result is closed; exit code 2 where one cannot be, which the "
    "output names (default: holes and borders stay)";

void add_chain(CLI::App& command, std::string& method, std::string& decimator) {
  command
      .add_option("--method", method,
                  "reconstruction; fit: the one that fits the scan best; auto: the search chooses")
      ->check(CLI::IsMember({"fit", "gp3", "poisson", "hoppe", "imls", "auto"}))
      ->capture_default_str();
  command
      .add_option(
          "--decimator", decimator,
          "bounded: every edit keeps the bound; schroeder: the paper's decimation, whose error is "
          "measured afterwards; auto: the search chooses, under a one-sided bound")
      ->check(CLI::IsMember({"bounded", "schroeder", "auto"}))
      ->capture_default_str();
}

int run(int argc, char** argv) {
  CLI::App app(
      "emax: a triangle mesh with as few triangles as possible, certified to lie within a "
      "tolerance "
      "of every point of a scan.");
  app.name("emax");
  app.set_version_flag("--version", "emax " EMAX_VERSION);
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* all, const CLI::Error& error) {
    const auto chosen = all->get_subcommands();
    return fmt::format("emax: {}; see emax {}--help\n", error.what(),
                       chosen.empty() ? "" : chosen.front()->get_name() + " ");
  });
  std::function<int()> chosen;

  OptimizeOptions optimize;
  CLI::App& optimize_command =
      *app.add_subcommand("optimize",
                          "make a mesh of a scan, searching for the reconstruction and the "
                          "decimation that give the fewest triangles");
  add_common(optimize_command, optimize.common);
  optimize_command
      .add_option("--max-error", optimize.max_error,
                  "tolerance: N in the cloud's unit, or N% of its width")
      ->required();
  optimize_command.add_option("-o,--output", optimize.output, "mesh: .ply .obj .stl .off")
      ->required();
  add_chain(optimize_command, optimize.method, optimize.decimator);
  optimize_command
      .add_option(
          "--bound", optimize.bound,
          "one-sided: every point of the cloud lies within the tolerance of the mesh; two-sided: "
          "also all of the mesh within the tolerance of a reference surface, and all of that "
          "surface within the tolerance of the mesh (default: two-sided, but one-sided with "
          "--decimator schroeder or auto)")
      ->check(CLI::IsMember({"two-sided", "one-sided"}));
  optimize_command.add_option("--seed", optimize.seed, "seed of every random choice")
      ->check(whole())
      ->capture_default_str();
  optimize_command
      .add_option("--effort", optimize.effort,
                  "quick: one good candidate; deep: four times as many as normal")
      ->check(CLI::IsMember({"quick", "normal", "deep"}))
      ->capture_default_str();
  optimize_command
      .add_option("--budget", optimize.budget,
                  "evaluations (default: by --effort; normal are those of --config, or without it "
                  "40, with the paper's decimation 60, fewer for more than 100,000 points)")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100000000}));
  optimize_command
      .add_option("--time", optimize.seconds, "stop the search after this many seconds")
      ->check(positive("seconds"));
  optimize_command
      .add_option("--jobs", optimize.jobs,
                  "worker processes, at most search.look_ahead of the configuration (default: one "
                  "per processor, as far as the memory allows)")
      ->check(CLI::Range(1u, 256u));
  optimize_command
      .add_option("--target-triangles", optimize.target_triangles,
                  "stop at a mesh within the tolerance of at most so many triangles")
      ->check(positive("triangles"));
  optimize_command
      .add_option("--stagnation", optimize.stagnation,
                  "stop after so many evaluations without a better mesh")
      ->check(positive("evaluations"));
  optimize_command.add_flag("--closed", optimize.closed, kClosedHelp);
  CLI::Option& polish = *optimize_command.add_flag(
      "--polish,!--no-polish", optimize.polish,
      "decimate the best mesh once more in the end, deep (default unless "
      "--effort is quick; only of the bounded decimator)");
  optimize_command.add_option("--resume", optimize.resume,
                              "folder that keeps the run: created when missing, continued when "
                              "there (default: MESH.run, removed when the run has ended)");
  optimize_command
      .add_option("--evaluation-time", optimize.evaluation_seconds,
                  "give an evaluation up after this many seconds (default: 600, or 0.002 a point "
                  "where that is more), and --polish after ten times as many")
      ->check(within(0.001, 1e7));
  optimize_command
      .add_option("--evaluation-memory", optimize.evaluation_memory,
                  "give an evaluation up that needs more: bytes, or N MB, N GB (default: 2 GB "
                  "and 8 KB a point, at most 7/8 of the memory)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(not_negative());  // before the other
  optimize_command.add_option("--config", optimize.config,
                              "settings and domains; `emax config` prints the defaults");
  optimize_command.callback([&] {
    if (polish.count() == 0) optimize.polish = optimize.effort != "quick";
    chosen = [&optimize] { return run_optimize(optimize); };
  });

  DecimateOptions decimate;
  CLI::App& decimate_command = *app.add_subcommand(
      "decimate", "reduce a mesh to as few triangles as a certified bound allows");
  decimate_command.add_option("MESH", decimate.mesh, "mesh: .ply .obj .stl .off")->required();
  decimate_command.add_option(
      "--cloud", decimate.cloud,
      "point cloud whose points have to lie within the tolerance of the result (default: "
      "the vertices of MESH)");
  decimate_command
      .add_option("--max-error", decimate.max_error,
                  "tolerance: N in the unit of the points, or N% of their width")
      ->required();
  std::string decimate_bound = "two-sided";
  decimate_command
      .add_option("--bound", decimate_bound,
                  "one-sided: every point lies within the tolerance of the result; two-sided: also "
                  "all of the result within the tolerance of MESH, and all of MESH within the "
                  "tolerance of the result")
      ->check(CLI::IsMember({"two-sided", "one-sided"}))
      ->capture_default_str();
  decimate_command.add_option(
      "--back-error", decimate.back_error,
      "how far the result may be from MESH, N or N% (default: --max-error)");
  decimate_command.add_option("-o,--output", decimate.output, "mesh: .ply .obj .stl .off")
      ->required();
  decimate_command
      .add_option("--effort", decimate.effort,
                  "how long to look for fewer triangles: quick only collapses edges, deep goes on "
                  "until nothing is gained")
      ->check(CLI::IsMember({"quick", "normal", "deep"}))
      ->capture_default_str();
  decimate_command.add_flag("--repair", decimate.repair,
                            "remove triangles that intersect others or are not manifold, and close "
                            "the holes that leaves in a closed mesh (default: kept, cut apart)");
  decimate_command.add_flag("--closed", decimate.closed, kClosedHelp);
  decimate_command
      .add_option("--feature-angle", decimate.feature_angle,
                  "keep edges sharp over which the surface turns by more than this many degrees, "
                  "and their corners; 40 suits machine parts; leave it out for noisy scans")
      ->check(within(1, 180));
  add_points_and_json(decimate_command, decimate.excluded_share, decimate.skip_invalid,
                      decimate.json);
  decimate_command
      .add_option("--time", decimate.seconds,
                  "stop after this many seconds, with the mesh reached by then")
      ->check(positive("seconds"));
  decimate_command.callback([&] {
    decimate.two_sided = decimate_bound == "two-sided";
    if (!decimate.two_sided && !decimate.back_error.empty()) {
      throw CLI::ValidationError(
          "--back-error bounds the other direction: it needs --bound two-sided");
    }
    chosen = [&decimate] { return run_decimate(decimate); };
  });

  ErrorOptions error;
  CLI::App& error_command =
      *app.add_subcommand("error", "measure and certify the maximum error of a mesh");
  add_common(error_command, error.common);
  error_command.add_option("MESH", error.mesh, "mesh: .ply .obj .stl .off")->required();
  error_command.add_option(
      "--max-error", error.max_error,
      "tolerance, N or N%: the output counts the points that are farther; exit "
      "code 2 when the tolerance is exceeded");
  error_command.add_flag("--two-sided", error.two_sided,
                         "also bound the distance of the whole mesh from the reference");
  error_command
      .add_option("--reference", error.reference,
                  "mesh or cloud that --two-sided measures against (default: the cloud itself)")
      ->needs("--two-sided");
  error_command
      .add_option("--quantile", error.quantiles,
                  "percent of the points whose greatest distance is printed; may be repeated "
                  "(default: 50 90 95 99 99.9)")
      ->expected(1)
      ->take_all()
      ->check(within(0, 100));
  error_command.add_option("--worst", error.worst, "how many of the farthest points are printed")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1000000}))
      ->capture_default_str();
  error_command.add_option("--color", error.color,
                           "write the cloud coloured by its distances: .ply");
  error_command
      .add_option("--color-mesh", error.color_mesh,
                  "write the mesh coloured by its vertices' distances to the reference: .ply")
      ->needs("--two-sided");
  error_command.callback([&] { chosen = [&error] { return run_error(error); }; });

  VerifyOptions verify;
  CLI::App& verify_command = *app.add_subcommand(
      "verify", "recompute what a certificate says; exit code 0 for yes, 2 for no");
  verify_command
      .add_option("CERTIFICATE", verify.certificate, "MESH.certificate.json, written beside a mesh")
      ->required();
  verify_command.add_option(
      "--cloud", verify.cloud,
      "the cloud, if it lies neither beside the certificate nor in the current folder");
  verify_command.add_option("--mesh", verify.mesh, "the mesh, if it is not beside the certificate");
  verify_command.add_option("--reference", verify.reference,
                            "the reference of a two-sided bound, if it lies neither beside the "
                            "certificate nor in the current folder");
  add_json(verify_command, verify.json);
  verify_command.callback([&] { chosen = [&verify] { return run_verify(verify); }; });

  std::string config_method = kFitMethod, config_decimator = "bounded";
  CLI::App& config_command =
      *app.add_subcommand("config", "print the default settings and domains, commented");
  add_chain(config_command, config_method, config_decimator);
  config_command.callback([&] {
    chosen = [&] {
      fmt::print("{}", default_config_text(chain_parameters(
                           method_for(config_method, config_decimator), config_decimator)));
      return kExitOk;
    };
  });

  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_type_name() == "TEXT") option->check(not_empty());
    }
  }
  std::vector<std::string> words =
      checked_words(app, std::span(argv, static_cast<std::size_t>(argc)));
  if (argc == 1) {
    to_standard_error(app.help());
    return kExitError;
  }
  try {
    std::ranges::reverse(words);  // as the parser asks for
    app.parse(std::move(words));
  } catch (const CLI::ParseError& parse_error) {
    return app.exit(parse_error) == 0 ? kExitOk : kExitError;
  }
  for (std::string* json :
       {&optimize.common.json, &decimate.json, &error.common.json, &verify.json}) {
    direct_json(*json);
  }
  verify_arithmetic();
  if (!verify_command.parsed()) note_interrupts();  // which has nothing to end well
  return chosen();
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::open_standard_streams();
  const auto complain = [](const std::string& text) {
    emax::to_standard_error("emax: " + text + "\n");
  };
  int code = emax::kExitError;
  try {
    code = emax::run(argc, argv);
  } catch (const emax::Error& error) {
    complain(error.what());
  } catch (const emax::Interrupted&) {
    complain("interrupted; nothing was written");
    code = emax::kExitInterrupted;
  } catch (const std::bad_alloc&) {
    complain("out of memory; use a smaller cloud or fewer --jobs");
  } catch (const std::system_error& error) {
    complain(error.what());
  } catch (const std::exception& error) {
    complain(std::string(error.what()) + " (a defect of the program; please report it)");
  }
  // Where it takes the JSON, what is flushed here is bound for standard error.
  if (std::fflush(stdout) != 0 && !emax::standard_output_is_json()) {
    complain(std::string("standard output cannot be written: ") + std::strerror(errno));
    return emax::kExitError;
  }
  return code;
}
