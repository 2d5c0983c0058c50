#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/app/machines.h"
#include "host/app/scan.h"
#include "host/parameters/chain_parameters.h"
#include "host/parameters/registry.h"

namespace emax {

// The subcommands. Each prints its result on standard output and returns the exit code. `json` is a
// file; it is empty if there is none, and if standard output takes the JSON (json_output.h).

struct OptimizeOptions {
  CommonOptions common;
  std::string max_error;  // empty: the error says what suits the scan
  int level = 0;          // of accuracy, in place of max_error
  std::string output;
  std::string method = kFitMethod;
  std::string decimator{Bounded::kName};
  std::string bound;  // empty: two-sided if the decimator supports it
  std::string config;
  std::uint64_t seed = 1;
  std::string effort = "normal";  // quick or deep: see search_budget()
  bool effort_is_given = false;
  std::optional<std::uint64_t> budget;  // nothing: that of the effort
  std::optional<double> seconds;
  unsigned jobs = 0;  // of each of the machines' processes; 0: one per processor
  Machines machines;
  std::string resume;  // the run's folder; empty: <output>.run, removed when the run has ended
  std::optional<std::uint64_t> target_triangles, stagnation;
  bool polish = true;
  bool closed = false;                  // every hole of the surface is closed
  std::string features{kNoFeatures};    // or kOnPlanes, kAllFeatures, kAutoFeatures
  std::string hole_reach;               // empty: the tolerance; none: holes stay
  std::size_t tile_triangles = 0;       // 0: not in tiles
  std::optional<Tolerance> thin;        // of tiles; nothing: half of max_error
  std::optional<std::uint64_t> memory;  // of tiles, bytes; nothing: half of what is free
  std::optional<double> evaluation_seconds;
  std::optional<std::uint64_t> evaluation_memory;  // bytes
};
int run_optimize(const OptimizeOptions& options);

// Of a tile, where the memory holds it.
inline constexpr std::uint64_t kTilePoints = 1 << 18;

struct ReconstructOptions {
  std::string cloud;
  std::string output;
  std::string unit;  // of the cloud's numbers; empty: what the file says
  std::string method = kFitMethod;
  std::vector<std::string> parameters;  // NAME=VALUE, in place of what suits the scan
  std::optional<Tolerance> thin;        // nothing: all points are taken
  std::optional<Tolerance> simplify;    // nothing: the surface as it was contoured
  std::optional<Tolerance> tolerance;   // of a decimation to follow
  std::uint64_t tile_points = 0;        // 0: as the memory needs it
  std::string tile_folder;              // empty: <output>.tiles
  bool keep_tiles = false;              // at the end, too
  Machines machines;
  std::optional<std::uint64_t> memory;  // bytes; nothing: half of what is free
  unsigned jobs = 0;                    // of each of the machines' processes; 0: one per processor
  std::string json;
  CloudReadOptions reading;
};
int run_reconstruct(const ReconstructOptions& options);

struct DecimateOptions {
  std::string mesh;
  std::string cloud;  // empty: the mesh's vertices, and its whole surface
  std::string unit;   // of the points; empty: what the file says
  std::string max_error;
  int level = 0;           // of accuracy, in place of max_error
  std::string back_error;  // empty: the tolerance
  std::string output;
  std::string effort = "normal";               // or quick, deep
  std::size_t quick_beyond = ~std::size_t{0};  // so many points, the effort is quick
  std::string objective = "triangles";         // or hoppe
  double feature_angle = 0;                    // degrees; 0: no features
  std::string features{kNoFeatures};           // or kOnPlanes, kAllFeatures, kAutoFeatures
  std::string hole_reach;                      // empty: the tolerance; none: holes stay
  std::string json;
  ReportOptions report;
  std::string excluded_share = "0";
  std::optional<double> seconds;
  unsigned threads = 0;                 // 0: one per processor
  std::optional<std::uint64_t> memory;  // bytes for the points; nothing: half of what is free
  std::size_t tile_triangles = 0;       // 0: the mesh is decimated as a whole if memory allows it
  std::string tile_folder;              // empty: beside the output
  Machines machines;
  bool two_sided = true;
  bool repair = false;  // remove intersecting triangles instead of keeping them
  bool closed = false;  // every hole is closed
  CloudReadOptions reading;
};
int run_decimate(const DecimateOptions& options);

struct ErrorOptions {
  CommonOptions common;
  std::string mesh;
  std::string max_error;  // empty: only measure
  int level = 0;          // of accuracy, in place of max_error
  bool two_sided = false;
  std::string reference;          // a mesh or a cloud; empty: the cloud itself
  std::vector<double> quantiles;  // percent; empty: the usual ones
  std::size_t worst = 5;
  std::string color, color_mesh;        // PLY files; empty: none
  std::string deviations;               // PLY or GLB; empty: none
  std::optional<std::uint64_t> memory;  // bytes; nothing: half of what is free
  Machines machines;
};
int run_error(const ErrorOptions& options);

struct InfoOptions {
  std::string file;
  CloudReadOptions reading;
  std::string json;
};
int run_info(const InfoOptions& options);

struct FeaturesOptions {
  std::string cloud;
  std::vector<std::string> outputs;  // PLY, OBJ, GLB or DXF
  std::string unit;                  // of the cloud's numbers; empty: what the file says
  std::string max_error;             // empty: what suits the scan
  int level = 0;                     // of accuracy, in place of max_error
  std::string method = "growing";    // or hough
  std::size_t least_support = 100;   // points
  std::uint64_t seed = 1;
  unsigned jobs = 0;  // 0: one per processor
  bool all = false;   // print every region
  std::string json;
  CloudReadOptions reading;
};
int run_features(const FeaturesOptions& options);

struct VerifyOptions {
  std::string certificate;
  std::string cloud, mesh, reference;  // empty: found by the names in the certificate
  std::string json;
  ReportOptions report;
  std::optional<std::uint64_t> memory;  // bytes; nothing: half of what is free
  Machines machines;
};
int run_verify(const VerifyOptions& options);

}  // namespace emax
