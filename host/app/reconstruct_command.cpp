#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/phase_progress.h"
#include "host/app/run_identity.h"
#include "host/app/scan_pieces.h"
#include "host/app/tile_folder.h"
#include "host/decimate/quadric_collapse.h"
#include "host/files/atomic_file.h"
#include "host/files/mesh_file.h"
#include "host/files/number_text.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/optimize/evaluation_limits.h"
#include "host/optimize/reference_fit.h"
#include "host/parameters/descriptions.h"
#include "host/report/json_parts.h"
#include "host/tiles/tiled_reconstruction.h"
#include "host/worker_pool/worker_parts.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

// What a point takes while it is reconstructed, of a tile also for what is around it.
constexpr std::uint64_t kBytesOfPoint = 2000, kBytesPerPointOfTile = 3000;
constexpr std::uint64_t kBytesPerPointInFiles = 300;  // of all files of all tiles
constexpr std::uint64_t kLeastOfTile = 1 << 12;

class ReconstructCommand {
 public:
  explicit ReconstructCommand(const ReconstructOptions& options)
      : options_(options),
        jobs_(options.jobs > 0 ? options.jobs : static_cast<unsigned>(processor_threads())),
        memory_(options.memory.value_or(standard_memory())),
        format_(mesh_format(options.output)) {
    check_output(options.output, mesh_endings());
    if (!options.json.empty()) check_output(options.json, kJsonEndings);
    check_distinct({options.output, options.json}, {options.cloud});
    check_not_among_scans(options.output, options.cloud);
    progress_.begin("reading", reading_seconds(options.cloud));
    pieces_.emplace(options.cloud, options.reading, options.unit, memory_, was_interrupted);
    progress_.end();
    require_unit(pieces_->scan().unit, format_, options.output);
    thin_ = in_cloud_unit(options.thin, "--thin");
    simplify_ = in_cloud_unit(options.simplify, "--simplify");
    in_tiles_ = options.tile_points > 0 || !pieces_->is_in_memory() ||
                pieces_->points() * kBytesOfPoint > memory_;
    if (in_tiles_ && options.method != kFitMethod && options.method != Imls::kName) {
      throw Error(fmt::format(
          "{}: {} points {}, and --method {} takes a cloud as a whole alone; leave --method out "
          "or take imls{}",
          options.cloud, grouped(pieces_->points()),
          options.tile_points > 0 ? "are to be reconstructed in tiles"
                                  : fmt::format("need {:.3g} GB, more than --memory",
                                                static_cast<double>(kBytesOfPoint) *
                                                    static_cast<double>(pieces_->points()) / 1e9),
          options.method, options.tile_points > 0 ? ", or leave --tile-points out" : ""));
    }
  }

  int run() {
    facts_.add("cloud", "{}", describe(pieces_->scan(), pieces_->points()));
    print_left_out(facts_, pieces_->scan().cloud);
    print_doubtful_unit(facts_, pieces_->scan().width, pieces_->scan().unit);
    in_tiles_ ? reconstruct_tiles() : reconstruct_whole();
    progress_.begin("checking the surface");
    validity_ = check_mesh(mesh_.view(), jobs_);
    topology_ = topology_of(mesh_.view());
    progress_.begin("writing");
    write_mesh(options_.output, mesh_, {.unit = pieces_->scan().unit});
    progress_.end();
    if (folder_ && !options_.keep_tiles) folder_->remove();
    facts_.add("result", "{}: {} triangles; {}", options_.output, grouped(mesh_.triangles.size()),
               describe(validity_));
    facts_.add("topology", "{}", describe(topology_));
    if (simplify_ > 0)
      facts_.add("simplified", "by at most {:.6g} as a root mean square", simplify_);
    if (!options_.keep_tiles) {
      facts_.add("next", "emax decimate {} --cloud {} --max-error N -o ...", options_.output,
                 options_.cloud);
    }
    if (json_is_wanted(options_.json)) write_json(options_.json, to_json().dump(2) + "\n");
    return kExitOk;
  }

 private:
  // As the options say them in place of those that suit the scan.
  void choose(std::string method, const ScanEstimate& estimate) {
    estimate_ = estimate;
    if (method == kFitMethod) {
      method = in_tiles_ ? std::string(Imls::kName) : first_method(estimate);
    }
    chain_ = fitted_chain(method, estimate, pieces_->scan().width);
    chain_.parameters.set(Fill::kMethod, Fill::Method::kNone);
    if (method == Imls::kName && may_be_coarse(estimate)) chain_.parameters.set(Imls::kCell, 2.0);
    for (const std::string& text : options_.parameters) set(text);
    facts_.add("scan", "points {:.3g} apart, noise {:.2g}", estimate.spacing, estimate.noise);
    std::string told;
    for (const Parameter& p : method_named(method).parameters) {
      told += fmt::format("{}{} {:g}", told.empty() ? "" : ", ", p.name,
                          chain_.parameters.by_name().at(p.name));
    }
    facts_.add("method", "{}: {}", method, told);
  }

  // A quarter of the triangles, from which a decimation comes to about as many
  // (docs/decisions/0032-reconstruction-in-tiles.md).
  bool may_be_coarse(const ScanEstimate& estimate) const {
    return options_.tolerance &&
           options_.tolerance->in_units(pieces_->scan().width) >= estimate.spacing / 2;
  }

  // NAME=VALUE.
  void set(const std::string& text) {
    const std::size_t split = text.find('=');
    const std::string name = text.substr(0, split);
    const Parameters& known = method_named(chain_.method).parameters;
    const auto parameter = std::ranges::find(known, name, &Parameter::name);
    if (parameter == known.end()) {
      std::string names;
      for (const Parameter& p : known) names += (names.empty() ? "" : ", ") + p.name;
      throw Error(fmt::format("--set {}: {} has no parameter '{}'; choose one of {}", text,
                              chain_.method, name, names));
    }
    std::optional<double> value;
    if (split != std::string::npos) value = parse_double(text.substr(split + 1));
    const bool whole = parameter->kind == Gene::Kind::kInteger;
    if (!value || !(*value >= parameter->lower && *value <= parameter->upper) ||
        (whole && *value != std::round(*value))) {
      throw Error(fmt::format("--set {}: give {} a {}number from {:g} to {:g}", text, name,
                              whole ? "whole " : "", parameter->lower, parameter->upper));
    }
    chain_.parameters.by_name()[name] = *value;
  }

  void reconstruct_whole() {
    const std::vector<Point> points = thinned_points();
    choose(options_.method, estimate_scan(points));
    progress_.begin("reconstructing", reference_seconds(points.size()));
    WorkerPoolOptions workers;
    workers.jobs = jobs_;
    workers.time_limit = std::chrono::hours(24 * 365);
    workers.memory_limit = options_.memory ? 0 : standard_limits(points.size()).memory;
    const std::unique_ptr<EvaluationPool> pool = make_worker_pool(points, {}, workers);
    pool->submit({0, chain_, 0, jobs_});
    std::optional<Completed> completed;
    while (!completed) {
      if (was_interrupted()) throw Interrupted{};
      completed = pool->wait_for(std::chrono::milliseconds(200));
    }
    if (const auto* failure = std::get_if<Failure>(&completed->outcome)) {
      throw Error(fmt::format("{}: {}", options_.cloud, failure->message));
    }
    mesh_ = std::move(std::get<ChainResult>(completed->outcome).mesh);
    if (simplify_ > 0) {
      progress_.begin("simplifying");
      mesh_ = collapse_by_quadrics(mesh_, simplify_).mesh;
    }
    taken_ = points.size();
  }

  double in_cloud_unit(const std::optional<Tolerance>& length, const char* option) const {
    return length ? below_width(*length, option, pieces_->scan()) : 0;
  }

  double normalised_thin() const { return pieces_->normalization().length(thin_); }

  std::vector<Point> thinned_points() {
    std::vector<Point> points = pieces_->scan().cloud.points;
    if (thin_ == 0) return points;
    std::vector<NumberedPoint> numbered;
    numbered.reserve(points.size());
    for (const Point& p : points) numbered.push_back({p, numbered.size()});
    points.clear();
    for (const NumberedPoint& p :
         thinned(std::move(numbered), pieces_->normalization(), normalised_thin())) {
      points.push_back(p.position);
    }
    facts_.add("thinned", "to {} points, one in a cube of {:.6g}", grouped(points.size()), thin_);
    return points;
  }

  void reconstruct_tiles() {
    const std::uint64_t most = points_of_tile();
    chain_ = fitted_chain(std::string(Imls::kName), {}, 1);
    for (const std::string& text : options_.parameters) set(text);  // before any file is made
    folder_.emplace(
        options_.tile_folder.empty() ? options_.output + ".tiles" : options_.tile_folder,
        pieces_->points(), kBytesPerPointInFiles);
    folder_->begin(identity(most));
    if (folder_->is_continued()) {
      facts_.add("continued", "from the tiles in {}", folder_->path().string());
    }
    progress_.begin("cutting the cloud into tiles", 2 * reading_seconds(options_.cloud));
    const CloudPartition cloud = CloudPartition::is_in(folder_->path())
                                     ? CloudPartition(folder_->path())
                                     : CloudPartition(source(), most, folder_->path());
    choose(std::string(Imls::kName), estimate_scan(cloud, normalised_thin()));
    facts_.add("tiles", "{} of at most {} points, in {}", grouped(cloud.parts().size()),
               grouped(most), folder_->path().string());
    progress_.begin("reconstructing the tiles");
    WorkerPartsOptions workers;
    workers.jobs = tiles_at_a_time(most);
    workers.interrupted = was_interrupted;
    TiledReconstruction made =
        reconstruct_in_tiles(cloud, chain_.parameters, estimate_,
                             {normalised_thin(), pieces_->normalization().length(simplify_)},
                             options_.machines.make_parts(folder_->path(), workers),
                             [&](double share) { progress_.advance(share); });
    tiles_ = cloud.parts().size();
    taken_ = made.points;
    mesh_ = std::move(made.mesh);
    if (taken_ < pieces_->points()) {
      facts_.add(thin_ > 0 ? "thinned" : "taken", "{} of the points{}", grouped(taken_),
                 thin_ > 0 ? fmt::format(", one in a cube of {:.6g}", thin_)
                           : "; the others repeat some, or are alone in their tile");
    }
  }

  CloudSource source() const {
    return {pieces_->normalization(), [this](const CloudSource::Take& take) {
              pieces_->for_each(
                  jobs_, [&](const ScanPieces::Piece& piece) { take(piece.points, piece.first); });
            }};
  }

  // Of few sizes, as the order of the triangles depends on it, and on nothing else of the memory.
  std::uint64_t points_of_tile() const {
    if (options_.tile_points > 0) return options_.tile_points;
    std::uint64_t points = kTilePoints;
    while (points > kLeastOfTile && points * kBytesPerPointOfTile > memory_) points /= 4;
    return points;
  }
  // So many tiles at a time as the memory holds.
  unsigned tiles_at_a_time(std::uint64_t points) const {
    const std::uint64_t held =
        std::max<std::uint64_t>(1, memory_ / (points * kBytesPerPointOfTile));
    return static_cast<unsigned>(std::min<std::uint64_t>(jobs_, held));
  }

  // What the files of the tiles depend on.
  std::string identity(std::uint64_t most) const {
    std::string text = fmt::format(
        "cloud {}\nthinned {}\nsimplified {}\nclasses left out {}{}\npoints of a tile {}\nset {}\n",
        sha256_of_input(options_.cloud), thin_, simplify_,
        fmt::join(options_.reading.left_out_classes, ","),
        options_.reading.skip_invalid ? ", and invalid points" : "", most,
        fmt::join(options_.parameters, " "));
    for (const auto& [name, value] : program_identity()) text += name + " " + value + "\n";
    return text;
  }

  Json to_json() const {
    Json json = {{"schema", "emax-reconstruct-1"},
                 {"cloud", options_.cloud},
                 {"points", pieces_->points()},
                 {"spacing", estimate_.spacing},
                 {"noise", estimate_.noise},
                 {"method", chain_.method},
                 {"parameters", chain_.parameters.by_name()},
                 {"simplify", simplify_},
                 {"tiles", tiles_},
                 {"taken", taken_},
                 {"mesh", options_.output},
                 {"triangles", mesh_.triangles.size()},
                 {"validity", emax::to_json(validity_)},
                 {"topology", emax::to_json(topology_)}};
    return json;
  }

  const ReconstructOptions& options_;
  const unsigned jobs_;
  const std::uint64_t memory_;
  const MeshFormat format_;
  PhaseProgress progress_;
  Facts facts_;
  std::optional<ScanPieces> pieces_;
  bool in_tiles_ = false;
  std::optional<TileFolder> folder_;
  ScanEstimate estimate_;
  ChainSettings chain_;
  TriangleMesh mesh_;
  std::size_t tiles_ = 0;
  std::uint64_t taken_ = 0;  // points that the surface is made of
  double thin_ = 0, simplify_ = 0;
  MeshValidity validity_;
  MeshTopology topology_;
};

}  // namespace

int run_reconstruct(const ReconstructOptions& options) { return ReconstructCommand(options).run(); }

}  // namespace emax
