#include "host/app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "host/app/completion.h"
#include "host/app/interrupt.h"
#include "host/app/option_checks.h"
#include "host/config/config.h"
#include "host/device/device_address.h"
#include "host/files/mesh_file.h"
#include "host/parameters/descriptions.h"

namespace emax {
namespace {

std::string mesh_help() { return fmt::format("mesh: {}", fmt::join(mesh_endings(), " ")); }

std::string input_help(std::string_view what, std::string_view endings) {
  return fmt::format("{}: {}, also with .gz or .zst behind; - for standard input", what, endings);
}

std::string mesh_input_help() {
  return input_help("mesh", fmt::format("{}", fmt::join(mesh_endings(), " ")));
}

void add_json(CLI::App& command, std::string& json) {
  command.add_option("--json", json,
                     "also write the result to this file, or with - to standard output; the text "
                     "then goes to standard error");
}

void add_report(CLI::App& command, ReportOptions& report) {
  command.add_option("--report", report.report,
                     "also write a page for a browser, with the deviations in 3-D: .html");
  command.add_option("--picture", report.picture, "also write a picture of the deviations: .png");
}

// At the end of the help: a command a line, and behind two blanks what it does.
void add_examples(CLI::App& command, const std::string& lines) {
  command.footer("Examples:\n" + lines);
}

void add_quiet(CLI::App& command, CommandLine& line) {
  command.add_flag("-q,--quiet", line.quiet,
                   "print nothing but errors; the exit code and the files say the result");
}

void add_progress(CLI::App& command, CommandLine& line) {
  add_quiet(command, line);
  command
      .add_option("--progress", line.progress,
                  "how standard error tells of the progress; json: a line of JSON for each change "
                  "(default: text, or none with --quiet)")
      ->check(CLI::IsMember({"text", "json", "none"}));
}

void add_reading(CLI::App& command, CloudReadOptions& reading) {
  command.add_flag("--skip-invalid", reading.skip_invalid,
                   "leave out points with NaN or infinite coordinates");
  command
      .add_option("--class", reading.left_out_classes,
                  "leave out the points of these classes of a LAS or LAZ file, N,N,...")
      ->delimiter(',')
      ->check(CLI::Range(0, 255));
}

void add_unit(CLI::App& command, std::string& unit) {
  std::vector<std::string> names;
  for (const Unit& u : kUnits) names.emplace_back(u.name);
  command
      .add_option(
          "--unit", unit,
          "what the numbers of the file are; lengths with a unit (0.5mm) need it unless the "
          "file says it, as E57 and some LAS files do")
      ->check(CLI::IsMember(names));
}

// --loa stands for a tolerance.
void add_level(CLI::App& command, int& level) {
  command
      .add_option("--loa", level,
                  "in place of --max-error: the level of represented accuracy (USIBD), as a "
                  "maximum; 20: 50 mm, 30: 15 mm, 40: 5 mm, 50: 1 mm")
      ->check(CLI::IsMember({20, 30, 40, 50}));
}

CLI::Option& add_memory(CLI::App& command, std::optional<std::uint64_t>& memory) {
  return *command
              .add_option("--memory", memory,
                          "a cloud that needs more memory than this is not kept but read in "
                          "pieces, with the same result: bytes, or N MB, N GB (default: half of "
                          "what is free)")
              ->transform(CLI::AsSizeValue(false))
              ->transform(not_negative());  // CLI11 runs this one first
}

void add_memory_for_mesh(CLI::App& command, std::optional<std::uint64_t>& memory) {
  add_memory(command, memory)
      .description(
          "a cloud that needs more memory than this is not kept but read in pieces, and a mesh "
          "that "
          "needs more than half of it in parts, with the same result: bytes, or N MB, N GB "
          "(default: half of what is free)");
}

void add_points_and_json(CLI::App& command, std::string& excluded_share, CloudReadOptions& reading,
                         std::string& json) {
  add_json(command, json);
  command
      .add_option("--exclude-outliers", excluded_share,
                  "share of the points (N or N%) that may lie farther than the tolerance; the "
                  "certificate lists them")
      ->capture_default_str();
  add_reading(command, reading);
}

void add_common(CLI::App& command, CommonOptions& options) {
  command
      .add_option("CLOUD", options.cloud,
                  input_help("point cloud", fmt::format("{}", fmt::join(cloud_endings(), " "))) +
                      "; or a folder of them")
      ->transform(standard_input_by_one_name())
      ->required();
  command
      .add_option("--device", options.device, "device that evaluates the kernel: " + device_help())
      ->capture_default_str();
  add_points_and_json(command, options.excluded_share, options.reading, options.json);
  add_report(command, options.report);
  add_unit(command, options.unit);
  command.add_flag("--brute-force", options.brute_force,
                   "compare every point with every triangle: slow, with the same result");
}

constexpr const char* kClosedHelp =
    "close every hole of the surface; if a hole cannot be closed, the exit code is 2 and the "
    "output names its place (default: holes and borders stay)";

void add_chain(CLI::App& command, std::string& method, std::string& decimator) {
  std::vector<std::string> methods = names_of(reconstruction_methods());
  methods.insert(methods.begin(), kFitMethod);
  methods.emplace_back(kAutoMethod);
  std::vector<std::string> decimator_names = names_of(decimators());
  decimator_names.emplace_back(kAutoDecimator);
  std::string meanings;
  for (const DecimatorDescription& d : decimators()) {
    meanings += fmt::format("{}: {}; ", d.name, d.meaning);
  }
  command
      .add_option("--method", method,
                  "reconstruction; fit: the one that fits the scan best; auto: the search chooses")
      ->check(CLI::IsMember(methods))
      ->capture_default_str();
  command
      .add_option("--decimator", decimator,
                  meanings + "auto: the search chooses, under a one-sided bound")
      ->check(CLI::IsMember(decimator_names))
      ->capture_default_str();
}

CLI::Option& add_thin(CLI::App& command, std::optional<Tolerance>& thin,
                      std::string_view standard) {
  return *command.add_option_function<std::string>(
      "--thin", [&thin](const std::string& text) { thin = parse_tolerance(text, "--thin"); },
      fmt::format("make the surface of one point of each cube of this side, N or N% or 5mm: dense "
                  "regions cost less, and sparse ones count as part of it (default: {})",
                  standard));
}

void add_features_followed(CLI::App& command, std::string& features, std::string& hole_reach,
                           std::string_view automatic) {
  command
      .add_option(
          "--features", features,
          fmt::format(
              "planes: find the planes of the scan, close the flat holes that the error cannot "
              "tell from the surface, and put vertices on the planes, on the lines where two meet "
              "and the corners of three; all: on cylinders and spheres, too; {}",
              automatic))
      ->check(CLI::IsMember({kNoFeatures, kOnPlanes, kAllFeatures, kAutoFeatures}))
      ->capture_default_str();
  command.add_option("--hole-reach", hole_reach,
                     "with --features: how far what closes a hole on a plane may be from the "
                     "surface, N or N% or 5mm; none: all holes stay open (default: --max-error)");
}

void add_optimize(CLI::App& app, CommandLine& line) {
  auto& optimize = line.optimize;
  CLI::App& command =
      *app.add_subcommand("optimize",
                          "make a mesh of a scan, searching for the reconstruction and the "
                          "decimation that give the fewest triangles");
  add_common(command, optimize.common);
  command.add_option(
      "--max-error", optimize.max_error,
      "tolerance: N in the cloud's unit, N% of its width, or 0.5mm; without it the command "
      "only says which one suits the scan");
  add_level(command, optimize.level);
  command.add_option("-o,--output", optimize.output, mesh_help() + " (required)");
  add_chain(command, optimize.method, optimize.decimator);
  std::vector<std::string> one_sided = names_of_decimators(false);
  one_sided.emplace_back(kAutoDecimator);
  command
      .add_option(
          "--bound", optimize.bound,
          "one-sided: every point of the cloud lies within the tolerance of the mesh; two-sided: "
          "also the whole mesh within the tolerance of a reference surface, and the whole surface "
          "within the tolerance of the mesh (default: two-sided, but one-sided with --decimator " +
              alternatives(one_sided) + ")")
      ->check(CLI::IsMember({"two-sided", "one-sided"}));
  command.add_option("--seed", optimize.seed, "seed of every random choice")
      ->check(whole())
      ->capture_default_str();
  CLI::Option& effort =
      *command
           .add_option(
               "--effort", optimize.effort,
               "quick: one good candidate; deep: four times as many evaluations as normal; with "
               "--tiles that of `emax decimate`, and quick for more than three million points "
               "unless said")
           ->check(CLI::IsMember({"quick", "normal", "deep"}))
           ->capture_default_str();
  CLI::Option& budget =
      *command
           .add_option(
               "--budget", optimize.budget,
               "number of evaluations (default: by --effort; for normal that of --config, else "
               "16, 40 with another --method, 60 with the paper's decimation, fewer for more "
               "than 100,000 points)")
           ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100000000}));
  command.add_option("--time", optimize.seconds, "stop the search after this many seconds")
      ->check(positive("seconds"));
  command
      .add_option("--jobs", optimize.jobs,
                  "worker processes, at most search.look_ahead of the configuration (default: one "
                  "per processor, as far as the memory allows)")
      ->check(CLI::Range(1u, 256u));
  CLI::Option& target =
      *command
           .add_option("--target-triangles", optimize.target_triangles,
                       "stop at a mesh within the tolerance that has at most this many triangles")
           ->check(positive("triangles"));
  CLI::Option& stagnation =
      *command
           .add_option("--stagnation", optimize.stagnation,
                       "stop after this many evaluations without a better mesh")
           ->check(positive("evaluations"));
  command.add_flag("--closed", optimize.closed, kClosedHelp);
  add_features_followed(command, optimize.features, optimize.hole_reach,
                        "auto: the search decides whether, and which planes count");
  CLI::Option& polish =
      *command.add_flag("--polish,!--no-polish", optimize.polish,
                        "at the end, decimate the four best with deep effort (default "
                        "unless --effort is quick; only with the bounded decimator)");
  CLI::Option& resume =
      *command.add_option("--resume", optimize.resume,
                          "folder of the run: created if it is missing, continued if it exists "
                          "(default: MESH.run, removed when the run has ended)");
  command
      .add_option("--evaluation-time", optimize.evaluation_seconds,
                  "stop an evaluation after this many seconds (default: 600, or 0.002 a point "
                  "if that is more), and --polish after ten times as many")
      ->check(within(0.001, 1e7));
  command
      .add_option("--evaluation-memory", optimize.evaluation_memory,
                  "stop an evaluation that needs more memory than this: bytes, or N MB, N GB "
                  "(default: 2 GB and 8 KB a point, at most 7/8 of the memory)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(not_negative());  // CLI11 runs this one first
  CLI::Option& config = *command.add_option(
      "--config", optimize.config, "settings and domains; `emax config` prints the defaults");
  CLI::Option& tiles =
      *command
           .add_option("--tiles", optimize.tile_triangles,
                       "for a cloud that is too large for the memory: reconstruct and decimate it "
                       "once, without a search, in tiles of at most this many triangles; 250000 "
                       "suits most machines")
           ->check(CLI::Range(std::size_t{1000}, std::size_t{1} << 32));
  add_thin(command, optimize.thin, "with --tiles half of the tolerance").needs(&tiles);
  add_memory(command, optimize.memory).needs(&tiles);
  for (CLI::Option* of_search : {&budget, &target, &stagnation, &resume, &config, &polish}) {
    tiles.excludes(of_search);
  }
  add_progress(command, line);
  add_examples(
      command,
      "  emax optimize scan.ply  which tolerance suits the scan\n"
      "  emax optimize scan.ply --max-error 0.5 -o part.ply  a mesh within 0.5 of the scan\n"
      "  emax optimize scan.ply --max-error 0.2% -o part.ply --effort quick  a first look\n"
      "  emax optimize scan.ply --max-error 0.5 -o part.ply --time 600  in ten minutes\n"
      "  emax optimize scans --max-error 5mm -o hall.ply --tiles 250000  a folder of large scans");
  command.callback([&] {
    if (optimize.output.empty() && (!optimize.max_error.empty() || optimize.level > 0)) {
      throw CLI::RequiredError("--output");
    }
    optimize.effort_is_given = effort.count() > 0;
    if (polish.count() == 0) optimize.polish = optimize.effort != "quick";
    line.chosen = [&optimize] { return run_optimize(optimize); };
  });
}

void add_decimate(CLI::App& app, CommandLine& line) {
  auto& decimate = line.decimate;
  CLI::App& command = *app.add_subcommand(
      "decimate", "reduce a mesh to as few triangles as a certified bound allows");
  command.add_option("MESH", decimate.mesh, mesh_input_help())->required();
  command.add_option(
      "--cloud", decimate.cloud,
      "point cloud whose points have to lie within the tolerance of the result (default: "
      "the vertices of MESH)");
  command.add_option(
      "--max-error", decimate.max_error,
      "tolerance: N in the unit of the points, N% of their width, or 0.5mm; several, separated by "
      "commas, write a mesh for each, MESH-N.ply, and their curve");
  add_level(command, decimate.level);
  command
      .add_option("--bound", line.decimate_bound,
                  "one-sided: every point lies within the tolerance of the result; two-sided: also "
                  "the whole result within the tolerance of MESH, and the whole of MESH within the "
                  "tolerance of the result")
      ->check(CLI::IsMember({"two-sided", "one-sided"}))
      ->capture_default_str();
  command.add_option("--back-error", decimate.back_error,
                     "how far the result may be from MESH, N or N% (default: --max-error)");
  command.add_option("-o,--output", decimate.output, mesh_help())->required();
  command
      .add_option("--effort", decimate.effort,
                  "how long to look for fewer triangles: quick only collapses edges, normal also "
                  "moves them, deep goes on until nothing is gained, for twice the time and more")
      ->check(CLI::IsMember({"quick", "normal", "deep"}))
      ->capture_default_str();
  command
      .add_option("--objective", decimate.objective,
                  "triangles: as few as the bound allows; hoppe: the least energy of Hoppe et al. "
                  "(1993) within the bound, which spreads vertices evenly and leaves more of them")
      ->check(CLI::IsMember({"triangles", "hoppe"}))
      ->capture_default_str();
  command.add_flag(
      "--repair", decimate.repair,
      "remove triangles that intersect others or are not manifold, and close the holes "
      "that this leaves in a closed mesh (default: keep them, cut apart)");
  command.add_flag("--closed", decimate.closed, kClosedHelp);
  command
      .add_option("--feature-angle", decimate.feature_angle,
                  "keep edges over which the surface turns by more than this many degrees within "
                  "the error, and their corners; 40 suits machine parts; leave it out for noisy "
                  "scans")
      ->check(within(1, 180));
  add_features_followed(command, decimate.features, decimate.hole_reach,
                        "auto: vertices with and without, and take the mesh with fewer triangles");
  add_points_and_json(command, decimate.excluded_share, decimate.reading, decimate.json);
  add_report(command, decimate.report);
  add_unit(command, decimate.unit);
  command
      .add_option("--time", decimate.seconds,
                  "stop after this many seconds, with the mesh reached by then")
      ->check(positive("seconds"));
  command
      .add_option("--threads", decimate.threads,
                  "threads to work with, which change no byte of the result (default: one per "
                  "processor)")
      ->check(CLI::Range(1u, 256u));
  command
      .add_option("--tiles", decimate.tile_triangles,
                  "decimate in tiles of at most this many triangles, for a mesh that is too large "
                  "for the memory as a whole; about 2% more triangles are left (default: 250000 "
                  "where the cloud needs more than --memory, else the mesh as a whole)")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{1} << 32));
  add_memory(command, decimate.memory);
  command.add_option("--tile-folder", decimate.tile_folder,
                     "for the points of the tiles where they do not fit into the memory, 40 bytes "
                     "each (default: MESH.tiles, removed at the end)");
  add_progress(command, line);
  add_examples(
      command,
      "  emax decimate mesh.stl --max-error 0.2% -o small.ply  fewer triangles\n"
      "  emax decimate mesh.stl --max-error 0.1,0.2,0.5 -o small.ply  a mesh for each\n"
      "  emax decimate part.obj --max-error 0.1 --feature-angle 40 -o small.obj  sharp edges");
  command.callback([&] {
    if (decimate.max_error.empty() && decimate.level == 0) {
      throw CLI::RequiredError("--max-error");
    }
    decimate.two_sided = line.decimate_bound == "two-sided";
    if (!decimate.two_sided && !decimate.back_error.empty()) {
      throw CLI::ValidationError(
          "--back-error bounds the other direction: it needs --bound two-sided");
    }
    if (!decimate.reading.left_out_classes.empty() && decimate.cloud.empty()) {
      throw CLI::ValidationError("--class leaves out points of a cloud: it needs --cloud");
    }
    line.chosen = [&decimate] { return run_decimate(decimate); };
  });
}

void add_reconstruct(CLI::App& app, CommandLine& line) {
  auto& reconstruct = line.reconstruct;
  CLI::App& command = *app.add_subcommand(
      "reconstruct", "make a surface of a scan with all its details, in tiles where it is large");
  command
      .add_option("CLOUD", reconstruct.cloud,
                  input_help("point cloud", fmt::format("{}", fmt::join(cloud_endings(), " "))) +
                      "; or a folder of them")
      ->required();
  command.add_option("-o,--output", reconstruct.output, mesh_help())->required();
  std::vector<std::string> methods = {kFitMethod};
  for (const MethodDescription& method : reconstruction_methods()) methods.push_back(method.name);
  command
      .add_option("--method", reconstruct.method,
                  "reconstruction; fit: gp3 for a scan without noise, else imls; in tiles imls")
      ->check(CLI::IsMember(methods))
      ->capture_default_str();
  command.add_option("--set", reconstruct.parameters,
                     "NAME=VALUE: a parameter of the method (`emax config` lists them) in place of "
                     "what suits the scan");
  add_thin(command, reconstruct.thin, "all points");
  command.add_option_function<std::string>(
      "--simplify",
      [&reconstruct](const std::string& text) {
        reconstruct.simplify = parse_tolerance(text, "--simplify");
      },
      "collapse edges while the surface deviates by no more than this, N or N% or 0.5mm, as a root "
      "mean square: flat regions get large triangles (default: none)");
  command
      .add_option("--memory", reconstruct.memory,
                  "a cloud that needs more memory than this is reconstructed in tiles, which "
                  "together need no more, but the surface needs its own: bytes, or N MB, N GB "
                  "(default: half of what is free)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(not_negative());  // CLI11 runs this one first
  command
      .add_option("--tile-points", reconstruct.tile_points,
                  "reconstruct in tiles of at most so many points, with the same surface")
      ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{1} << 32));
  command.add_option("--tile-folder", reconstruct.tile_folder,
                     "for the files of the tiles, 300 bytes a point (default: MESH.tiles, removed "
                     "at the end; after an interruption the same command goes on with it)");
  command
      .add_option("--jobs", reconstruct.jobs,
                  "threads, or tiles at a time, which change no byte of the result (default: one "
                  "per processor)")
      ->check(CLI::Range(1u, 256u));
  add_reading(command, reconstruct.reading);
  add_unit(command, reconstruct.unit);
  add_json(command, reconstruct.json);
  add_progress(command, line);
  add_examples(command,
               "  emax reconstruct scan.ply -o surface.ply  the surface of a scan\n"
               "  emax reconstruct hall.las -o hall.ply --memory 2GB  one that is larger than the "
               "memory");
  command.callback([&] { line.chosen = [&reconstruct] { return run_reconstruct(reconstruct); }; });
}

void add_error(CLI::App& app, CommandLine& line) {
  auto& error = line.error;
  CLI::App& command =
      *app.add_subcommand("error", "measure and certify the maximum error of a mesh");
  add_common(command, error.common);
  command.add_option("MESH", error.mesh, mesh_input_help())->required();
  command.add_option("--max-error", error.max_error,
                     "tolerance, N or N%: the output counts the points that are farther; exit "
                     "code 2 when the tolerance is exceeded");
  add_level(command, error.level);
  command.add_flag("--two-sided", error.two_sided,
                   "also bound the distance of the whole mesh from the reference");
  command
      .add_option("--reference", error.reference,
                  "mesh or cloud that --two-sided measures against (default: the cloud itself)")
      ->needs("--two-sided");
  command
      .add_option("--quantile", error.quantiles,
                  "percent of the points whose greatest distance is printed; may be repeated "
                  "(default: 50 90 95 99 99.9)")
      ->expected(1)
      ->take_all()
      ->check(within(0, 100));
  command.add_option("--worst", error.worst, "how many of the farthest points are printed")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1000000}))
      ->capture_default_str();
  command.add_option("--color", error.color, "write the cloud coloured by its distances: .ply");
  command
      .add_option("--color-mesh", error.color_mesh,
                  "write the mesh coloured by its vertices' distances to the reference: .ply")
      ->needs("--two-sided");
  command.add_option(
      "--deviations", error.deviations,
      "write the mesh with the greatest deviation of the points at each triangle and vertex: .ply "
      ".glb");
  add_memory_for_mesh(command, error.memory);
  add_quiet(command, line);
  add_examples(command,
               "  emax error scan.ply part.ply  the greatest distance, quantiles, histogram\n"
               "  emax error scan.ply part.ply --max-error 0.5  which points are farther than 0.5\n"
               "  emax error scan.ply part.ply --color errors.ply  the scan coloured by distance");
  command.callback([&] { line.chosen = [&error] { return run_error(error); }; });
}

void add_verify(CLI::App& app, CommandLine& line) {
  auto& verify = line.verify;
  CLI::App& command = *app.add_subcommand(
      "verify", "check a certificate by recomputing its claims; exit code 0: it holds, 2: not");
  command
      .add_option("CERTIFICATE", verify.certificate, "MESH.certificate.json, written beside a mesh")
      ->required();
  command.add_option(
      "--cloud", verify.cloud,
      "the cloud, if it lies neither beside the certificate nor in the current folder");
  command.add_option("--mesh", verify.mesh, "the mesh, if it is not beside the certificate");
  command.add_option("--reference", verify.reference,
                     "the reference of a two-sided bound, if it lies neither beside the "
                     "certificate nor in the current folder");
  add_json(command, verify.json);
  add_report(command, verify.report);
  add_memory_for_mesh(command, verify.memory);
  add_quiet(command, line);
  add_examples(
      command,
      "  emax verify part.ply.certificate.json  whether the certificate holds\n"
      "  emax verify part.ply.certificate.json --cloud scans/scan.ply  with the scan elsewhere");
  command.callback([&] { line.chosen = [&verify] { return run_verify(verify); }; });
}

void add_config(CLI::App& app, CommandLine& line) {
  CLI::App& command =
      *app.add_subcommand("config", "print the default settings and domains, commented");
  add_chain(command, line.config_method, line.config_decimator);
  command
      .add_option("--features", line.config_features,
                  "those of the search's candidates; auto: the search decides")
      ->check(CLI::IsMember({kNoFeatures, kOnPlanes, kAllFeatures, kAutoFeatures}))
      ->capture_default_str();
  command.callback([&] {
    line.chosen = [&line] {
      fmt::print("{}", default_config_text(
                           chain_parameters(method_for(line.config_method, line.config_decimator),
                                            line.config_decimator, line.config_features)));
      return kExitOk;
    };
  });
}

void add_features(CLI::App& app, CommandLine& line) {
  auto& features = line.features;
  CLI::App& command =
      *app.add_subcommand("features", "find the planes, cylinders and spheres of a scan");
  command
      .add_option("CLOUD", features.cloud,
                  input_help("point cloud", fmt::format("{}", fmt::join(cloud_endings(), " "))) +
                      "; or a folder of them")
      ->required();
  command
      .add_option("-o,--output", features.outputs,
                  "the points by region: .ply with colours, .obj or .glb with groups; or .dxf with "
                  "the outlines of the planes; may be repeated")
      ->expected(1)
      ->take_all();
  command.add_option(
      "--max-error", features.max_error,
      "how far the points of a region may lie from its shape, N or N% (default: what "
      "suits the scan, as emax info says it)");
  add_level(command, features.level);
  command
      .add_option("--method", features.method,
                  "how planes are searched: growing from flat places, or a Hough transform")
      ->check(CLI::IsMember({"growing", "hough"}))
      ->capture_default_str();
  command.add_option("--least-points", features.least_support, "of a region")
      ->check(CLI::Range(std::size_t{8}, std::size_t{1} << 32))
      ->capture_default_str();
  command.add_option("--seed", features.seed, "of the search for cylinders and spheres")
      ->check(whole())
      ->capture_default_str();
  command.add_flag("--all", features.all, "print every region, not only the 20 greatest");
  command
      .add_option("--jobs", features.jobs,
                  "threads, which change no byte of the result (default: one per processor)")
      ->check(CLI::Range(1u, 256u));
  add_reading(command, features.reading);
  add_unit(command, features.unit);
  add_json(command, features.json);
  add_progress(command, line);
  add_examples(command,
               "  emax features hall.las  the planes, cylinders and spheres, the greatest first\n"
               "  emax features hall.las --max-error 15mm --unit m -o walls.dxf  the outlines");
  command.callback([&] { line.chosen = [&features] { return run_features(features); }; });
}

void add_info(CLI::App& app, CommandLine& line) {
  auto& info = line.info;
  CLI::App& command = *app.add_subcommand(
      "info", "say what a file of a cloud or a mesh holds, and which tolerance suits it");
  command
      .add_option("FILE", info.file,
                  input_help("cloud or mesh",
                             fmt::format("{} .stl .dxf", fmt::join(cloud_endings(), " "))) +
                      "; or a folder of clouds")
      ->required();
  add_reading(command, info.reading);
  add_json(command, info.json);
  add_examples(command,
               "  emax info scan.ply  points, extent, spacing, noise, a tolerance that suits");
  command.callback([&] { line.chosen = [&info] { return run_info(info); }; });
}

void add_completion(CLI::App& app, CommandLine& line) {
  CLI::App& command = *app.add_subcommand(
      "completion", "print the script that completes commands and options in a shell");
  command.add_option("SHELL", line.shell, "the shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command.callback([&] {
    line.chosen = [&] {
      fmt::print("{}", completion_script(app, line.shell));
      return kExitOk;
    };
  });
}

constexpr std::array kCommands = {add_optimize, add_reconstruct, add_decimate,
                                  add_error,    add_verify,      add_features,
                                  add_info,     add_config,      add_completion};

}  // namespace

void add_commands(CLI::App& app, CommandLine& line) {
  for (const auto add : kCommands) add(app, line);
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_type_name() == "TEXT") option->check(not_empty());
    }
  }
}

std::array<std::string*, 7> json_options(CommandLine& line) {
  return {&line.optimize.common.json, &line.reconstruct.json, &line.decimate.json,
          &line.error.common.json,    &line.verify.json,      &line.info.json,
          &line.features.json};
}

}  // namespace emax
