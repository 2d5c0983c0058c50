#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/app/certified_result.h"
#include "host/app/commands.h"
#include "host/app/decimation_curve.h"
#include "host/app/decimation_progress.h"
#include "host/app/given_reference.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/proven_decimation.h"
#include "host/app/reference_text.h"
#include "host/app/report_output.h"
#include "host/app/scan_pieces.h"
#include "host/app/tile_folder.h"
#include "host/app/tiled_scan.h"
#include "host/app/tolerated_meshes.h"
#include "host/decimate/certified_decimation.h"
#include "host/decimate/decimation_sequence.h"
#include "host/decimate/joining_distance.h"
#include "host/files/atomic_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/merge_vertices.h"
#include "host/measure/error_constraint.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

using Effort = DecimationSettings::Effort;

// In tiles, whose surfaces average noise away, points of the cloud farther than this share of the
// tolerance from the mesh are joined to it: nearer ones are mostly noise.
constexpr double kFarInTiles = 0.99, kLeastFarInTiles = 0.5;
// Where tiles are needed and not asked for.
constexpr std::size_t kTileTriangles = 250'000;
// The points of a cloud in parts, and of the tiles that are worked at.
constexpr std::uint64_t kBytesPerPointInTiles = 40;

Effort effort_named(const std::string& name) {
  return name == "quick" ? Effort::kCollapse : name == "deep" ? Effort::kDeep : Effort::kRelax;
}

class DecimateCommand {
 public:
  explicit DecimateCommand(const DecimateOptions& options)
      : progress_(options.seconds ? std::optional<std::chrono::duration<double>>(*options.seconds)
                                  : std::nullopt),
        options_(options),
        own_cloud_(options.cloud.empty()),
        memory_(options.memory.value_or(standard_memory())),
        share_(parse_share(options.excluded_share)),
        bounds_(tolerated_meshes(options.max_error, options.level, options.output)),
        output_(bounds_.front().output) {
    const bool several = bounds_.size() > 1;
    if (several && share_ > 0) {
      throw Error("--exclude-outliers: give one --max-error, as each would exclude other points");
    }
    tile_triangles_ = options.tile_triangles;
    if (tile_triangles_ > 0) check_tiles();
    std::optional<Tolerance> back;
    if (!options.back_error.empty()) back = parse_tolerance(options.back_error, "--back-error");
    const std::optional<Tolerance> reach = given_hole_reach(options.hole_reach, options.features);
    const std::filesystem::path curve = several ? curve_path(options.output) : "";
    for (const ToleratedMesh& bound : bounds_) {
      check_mesh_outputs(bound.output, options.two_sided);
      const ReportOptions report = reports_of(bound);
      check_report_outputs(report);
      check_distinct({bound.output, certificate_path(bound.output), options.json, curve,
                      report.report, report.picture},
                     {options.mesh, options.cloud});
    }
    if (!options.json.empty()) check_output(options.json, kJsonEndings);
    for (const ToleratedMesh& bound : bounds_) check_not_among_scans(bound.output, options.cloud);
    read_inputs();
    if (reach) hole_reach_ = tolerance_below_width(*reach, "--hole-reach", scan());
    if (back) back_ = tolerance_below_width(*back, "--back-error", scan());
    for (ToleratedMesh& bound : bounds_) bound.tolerance = bound.tolerance.in_unit_of(scan().unit);
    // All tolerances have the same reference, which is made for the smallest.
    std::ranges::sort(bounds_, {},
                      [&](const ToleratedMesh& b) { return b.tolerance.in_units(scan().width); });
    for (const ToleratedMesh& bound : bounds_)
      tolerance_below_width(bound.tolerance, "--max-error", scan());
    set_bound(bounds_.front());
    settings_.decimation.two_sided = options.two_sided;
    is_large_ = pieces_->points() > options.quick_beyond;
    settings_.decimation.effort = effort_named(is_large_ ? "quick" : options.effort);
    settings_.decimation.feature_angle = options.feature_angle;
    settings_.decimation.threads = options.threads > 0 ? options.threads : processor_threads();
    if (options.objective == "hoppe") {
      settings_.decimation.objective = DecimationSettings::Objective::kHoppe;
    }
    format_ = mesh_format(options.output);
    require_unit(scan().unit, format_, options.output);
    settings_.storage = storage_of(format_);
    require_storable(given_, format_, std::min(epsilon_, epsilon_back()), options.output);
  }

  ~DecimateCommand() {
    tiled_.reset();
    if (folder_) folder_->remove();
  }
  DecimateCommand(const DecimateCommand&) = delete;
  DecimateCommand& operator=(const DecimateCommand&) = delete;

  int run() {
    progress_.finish();
    print_task(facts_);
    progress_.begin("making the reference surface", joining_seconds(pieces_->points()));
    make_reference();
    settings_.decimation.interrupted = [&] { return progress_.out_of_time() || was_interrupted(); };
    settings_.decimation.advanced = [&](double share, std::size_t triangles) {
      progress_.show(share, triangles);
    };
    return bounds_.size() > 1 ? run_sequence() : run_once();
  }

 private:
  void read_inputs() {
    progress_.begin("reading", reading_seconds(options_.mesh) +
                                   (own_cloud_ ? 0 : reading_seconds(options_.cloud)));
    MeshFile file = read_mesh_file(options_.mesh);
    given_ = std::move(file.mesh);
    lost_attributes_ = std::move(file.attributes);
    if (own_cloud_) {
      vertices_ = vertices_of(options_.mesh, given_);
      vertices_.unit = options_.unit.empty() ? file.unit : unit_named(options_.unit);
      pieces_.emplace(vertices_);
    } else {
      // Once the decimation has begun, an interrupt ends that, and what it reached is proven.
      const auto interrupted = [this] { return !has_begun_ && was_interrupted(); };
      pieces_.emplace(options_.cloud, options_.reading, options_.unit, memory_, interrupted);
      require_unit_of(scan(), options_.mesh, file.unit);
    }
    drop_unused_vertices(given_.vertices, given_.triangles);
    // The checksums are those of the files as they were read: files may change while the decimation
    // runs.
    mesh_sha256_ = sha256_of_input(options_.mesh);
    cloud_sha256_ = own_cloud_ ? mesh_sha256_ : sha256_of_input(scan().path);
    if (pieces_->is_in_memory()) return;
    pieces_->require_in_memory(options_.report);
    if (tile_triangles_ == 0) tile_triangles_ = kTileTriangles;
    check_tiles();
  }

  // A tile knows neither the collapses of another tolerance nor the edges of the whole start.
  void check_tiles() const {
    const auto refuse = [this](std::string_view option) {
      throw Error(fmt::format("{} cannot be combined with {}",
                              options_.tile_triangles > 0
                                  ? "--tiles"
                                  : "a cloud that needs more than --memory, so tiles,",
                              option));
    };
    if (bounds_.size() > 1) refuse("more than one --max-error");
    if (options_.feature_angle > 0) refuse("--feature-angle");
    if (options_.features != kNoFeatures) refuse("--features");
    if (options_.objective == "hoppe") refuse("--objective hoppe");
  }

  // Makes the reference and the file that holds it.
  void make_reference() {
    ReferenceWishes wishes = {.repair = options_.repair,
                              .closed = options_.closed,
                              .threads = settings_.decimation.threads};
    if (tile_triangles_ > 0) {
      begin_tiles();
      reference_ = tiled_->make_reference(wishes);
    } else {
      KeptReference made = reference_with_room(
          scan(), given_.view(), epsilon_, excludable(), wishes.threads,
          [&](const KeptPoints& kept) { return reference_of(kept.points, wishes); });
      kept_ = std::move(made.kept);
      reference_ = std::move(made.reference);
    }
    if (was_interrupted()) throw Interrupted{};
    has_begun_ = true;
    if (!options_.two_sided) return;
    const TriangleMesh& mesh = reference_.surface.mesh;
    if (reference_.is_as_given()) {
      file_.emplace(options_.mesh, mesh, scan().cloud.points, mesh_sha256_);
      return;
    }
    const ReportOptions report = reports_of(bounds_.front());
    check_distinct({reference_file(), options_.json, report.report, report.picture},
                   {options_.mesh, options_.cloud});
    file_.emplace(reference_file(), mesh, scan().cloud.points);
  }

  GivenReference reference_of(std::span<const Point> kept, ReferenceWishes wishes) {
    find_planes(kept);
    if (closes_holes()) wishes.planes = settings_.decimation.planes.get();
    wishes.plane_epsilon = epsilon_;
    wishes.plane_farthest = hole_reach_.value_or(epsilon_);
    progress_.begin("making the reference surface", joining_seconds(pieces_->points()));
    return emax::make_reference(given_, kept,
                                joining_distance(given_, kept, epsilon_, was_interrupted), wishes,
                                was_interrupted);
  }

  void begin_tiles() {
    TiledScanSettings wanted;
    wanted.epsilon = epsilon_;
    // The decimation keeps a distance from the tolerance that allows for what the file rounds.
    const double rounding = storage_displacement(given_, settings_.storage);
    wanted.far = std::max(kFarInTiles * epsilon_ - 4 * rounding, kLeastFarInTiles * epsilon_);
    wanted.excludable = excludable();
    wanted.triangles_of_a_tile = tile_triangles_;
    wanted.threads = settings_.decimation.threads;
    wanted.memory = memory_;
    wanted.runner = options_.machines.tiles.get();
    wanted.interrupted = was_interrupted;
    if (!pieces_->is_in_memory()) {
      TileFolder folder(
          options_.tile_folder.empty() ? options_.output + ".tiles" : options_.tile_folder,
          pieces_->points(), kBytesPerPointInTiles);
      folder.begin(fmt::format("the points of {}, without the classes {}{}\n", cloud_sha256_,
                               fmt::join(options_.reading.left_out_classes, ","),
                               options_.reading.skip_invalid ? " and invalid points" : ""));
      folder_ = std::move(folder);  // it is this command's from now on
      wanted.folder = folder_->path();
    }
    tiled_.emplace(*pieces_, given_, std::move(wanted));
  }

  void set_bound(const ToleratedMesh& bound) {
    output_ = bound.output;
    epsilon_ = bound.tolerance.in_units(scan().width);
    settings_.decimation.epsilon = epsilon_;
    settings_.decimation.epsilon_back = back_.value_or(epsilon_);
  }

  // The planes, or all shapes, that vertices are to lie on, for the present tolerance.
  void find_planes(std::span<const Point> kept) {
    if (options_.features == kNoFeatures) return;
    progress_.begin("searching planes", joining_seconds(kept.size()));
    settings_.decimation.planes = std::make_shared<const PlaneParts>(
        find_plane_parts(kept, epsilon_, settings_.decimation.threads,
                         [] {
                           if (was_interrupted()) throw Interrupted{};
                         },
                         {.curved = options_.features == kAllFeatures}));
    settings_.decimation.without_planes_too = options_.features == kAutoFeatures;
  }

  int run_once() {
    progress_.begin("assigning the points", joining_seconds(pieces_->points()));
    settings_.early = [this](const CertifiedDecimation& made) { write_early(made); };
    result_ = tiled_ ? tiled_->decimate(reference_.surface.mesh, settings_)
                     : decimate_scan(reference_.surface.mesh, scan(), kept_, settings_);
    judge();
    progress_.finish();
    feasible_ ? print_result(facts_) : refuse(facts_);
    print_time(
        result_.repairs > 0
            ? fmt::format("; results that missed the bound and were corrected: {}", result_.repairs)
            : "");
    if (options_.report.any()) {
      write_report(options_.report, report_of(bounds_.front()), facts_);
    }
    write_json();
    return exit_code(feasible_);
  }

  // What is left of long work if it is killed.
  void write_early(const CertifiedDecimation& made) {
    result_ = made;
    prove_and_write();
    if (!feasible_) return;
    facts_.add_passing("so far", "{}: {} triangles, certified", output_.string(),
                       grouped(made.mesh.triangles.size()));
    std::fflush(stdout);
  }

  // A mesh for each bound, the smallest first, from one sequence of collapses.
  int run_sequence() {
    DecimationSequence sequence(reference_.surface.mesh, kept_.points);
    std::vector<CurveRow> curve;
    std::vector<MadeReport> reports;
    for (const ToleratedMesh& bound : bounds_) {
      set_bound(bound);
      find_planes(kept_.points);
      progress_.begin("assigning the points", joining_seconds(kept_.points.size()));
      result_ = decimate_certified(
          reference_.surface.mesh, ProvenPoints(kept_.points), settings_,
          [&](const DecimationSettings& settings) { return sequence.cut(settings); });
      judge();
      progress_.finish();
      curve.push_back(
          {bound, epsilon_, feasible_, result_.mesh.triangles.size(), result_.points.e_max_upper});
      if (options_.report.any()) reports.push_back(silent_report(bound));
      if (was_interrupted() || result_.interrupted) break;
    }
    print_reference(facts_);
    print(curve);
    draw(curve, curve_path(options_.output));
    print_time("");
    for (MadeReport& made : reports) {
      made.data.curve = report_curve(curve);
      write_report(made.files, std::move(made.data), made.facts);
    }
    if (json_is_wanted(options_.json)) {
      emax::write_json(options_.json, to_json_text(curve, options_.mesh, options_.report));
    }
    return exit_code(curve.size() == bounds_.size() &&
                     std::ranges::all_of(curve, &CurveRow::feasible));
  }

  // A report that is written when all tolerances are done, as it shows the curve.
  struct MadeReport {
    ReportOptions files;
    ReportData data;
    Facts facts;
  };

  MadeReport silent_report(const ToleratedMesh& bound) const {
    Facts facts = facts_;
    facts.be_silent(true);
    feasible_ ? print_result(facts) : refuse(facts);
    facts.be_silent(false);
    return {reports_of(bound), report_of(bound), std::move(facts)};
  }

  ReportData report_of(const ToleratedMesh& bound) const {
    ReportData report = report_of_result(options_.report, result(), bound.output,
                                         feasible_ ? std::optional(written_) : std::nullopt);
    report.command = "decimate";
    report.parameters.push_back({"objective", options_.objective});
    if (!own_cloud_)
      report.provenance.push_back(report_input("input", options_.mesh, mesh_sha256_));
    report.times.push_back({"decimation", progress_.seconds()});
    return report;
  }

  // The files of --report and --picture, named as the meshes are if there are several.
  ReportOptions reports_of(const ToleratedMesh& bound) const {
    if (bounds_.size() == 1) return options_.report;
    return {named_for(options_.report.report, bound), named_for(options_.report.picture, bound)};
  }

  // Proves the decimator's result, and writes it if it keeps the bounds.
  void judge() {
    progress_.begin("certifying the result", certifying_seconds(pieces_->points()));
    prove_and_write();
  }

  void prove_and_write() {
    proven_ = tiled_ ? tiled_->prove(result_, file_ ? &reference_.surface.mesh : nullptr)
                     : proofs_of(result_, scan());
    if (settings_.decimation.planes) {
      regions_ =
          regions_of(result_.mesh, *settings_.decimation.planes,
                     beside_shape(reference_.surface.mesh, settings_.storage, epsilon_), epsilon_);
    }
    feasible_ = may_leave_out_own_vertices() || result_.points.excluded.size() <= excludable();
    if (feasible_) write();
  }

  int exit_code(bool feasible) const {
    if (was_interrupted()) return kExitInterrupted;
    return feasible && reference_.all_closed() ? kExitOk : kExitNo;
  }

  bool closes_holes() const { return options_.hole_reach != kNoHoleReach; }
  const Scan& scan() const { return pieces_->scan(); }
  double epsilon_back() const { return settings_.decimation.epsilon_back; }
  std::size_t excludable() const { return excludable_points(share_, pieces_->points()); }
  // Vertices of removed triangles are not part of the remaining surface.
  bool may_leave_out_own_vertices() const { return own_cloud_ && reference_.surface.dropped > 0; }
  double percent(double length) const { return 100 * length / scan().width; }

  std::filesystem::path reference_file() const {
    if (reference_.is_as_given()) return options_.mesh;
    return reference_path(options_.output);
  }

  void print_reference(Facts& facts) const {
    print(facts, reference_, options_.two_sided ? reference_file().string() : "");
  }

  void print_task(Facts& facts) const {
    facts.add("mesh", "{}: {} triangles", options_.mesh, grouped(given_.triangles.size()));
    if (!lost_attributes_.empty()) {
      facts.add("not kept", "{}: the result holds vertices and triangles alone",
                fmt::join(lost_attributes_, ", "));
    }
    facts.add("points", "{}: {}{}, width {}", scan().path.string(), grouped(pieces_->points()),
              own_cloud_ ? " vertices" : "", length_text(scan().width, scan().unit));
    print_left_out(facts, scan().cloud);
    print_doubtful_unit(facts, scan().width, scan().unit);
    std::string tolerances;
    for (const ToleratedMesh& bound : bounds_) {
      if (bounds_.size() == 1) {
        tolerances = to_text(bound.tolerance, scan().width, scan().unit);
      } else {
        tolerances += (tolerances.empty() ? "" : ", ") + bound.text;
      }
    }
    const bool own_back = options_.two_sided && epsilon_back() != epsilon_;
    facts.add("tolerance", "{}{}, {}{}", tolerances, level_text(options_.level),
              options_.two_sided ? "two-sided" : "one-sided",
              own_back ? fmt::format(", mesh to reference {:.6g}", epsilon_back()) : "");
    if (is_large_) {
      facts.add("effort", "quick, for more than {} points; --effort normal finds fewer triangles",
                grouped(options_.quick_beyond));
    }
    std::fflush(stdout);
  }

  void write() {
    if (file_) {
      proven_.reference = bound_of(result_, epsilon_back(), *file_, proven_.points_to_reference);
      proven_.reference_path = file_->path();
    }
    written_ = write_result(output_, result(), file_ ? &*file_ : nullptr);
  }

  CertifiedResult result() const {
    return {.cloud = {scan(), cloud_sha256_, options_.reading, own_cloud_,
                      pieces_->is_in_memory() ? nullptr : &*pieces_},
            .epsilon = epsilon_,
            .mesh = result_.mesh,
            .proven = proven_,
            .chain = chain_of(settings_.decimation),
            .regions = regions_ ? &*regions_ : nullptr};
  }

  void print_result(Facts& facts) const {
    print_reference(facts);
    facts.add("result", "{}: {} triangles; {}", output_.string(),
              grouped(result_.mesh.triangles.size()), describe(result_.validity));
    facts.add(
        "topology", "{}",
        describe(proven_.topology,
                 proven_.reference ? std::optional(proven_.reference->topology) : std::nullopt));
    facts.add("e_max",
              "{:.9g} certified, at most {:.9g} ({:.4g}% of the width): every point to the mesh",
              result_.points.e_max_upper, epsilon_, percent(result_.points.e_max_upper));
    if (regions_) print(facts, *regions_, *settings_.decimation.planes);
    if (proven_.reference)
      print(facts, *proven_.reference, epsilon_, scan().width, reference_file());
    if (!may_leave_out_own_vertices()) {
      print_excluded(facts, result_.points, excludable());
    } else if (!result_.points.excluded.empty()) {
      facts.add("left out",
                "vertices of removed triangles: {}, up to {:.9g} from the result; the certificate "
                "names them",
                grouped(result_.points.excluded.size()), result_.points.e_max_upper_all);
    }
    facts.add("kernel", "e_max^2 bits 0x{:08x} at point {}", proven_.kernel.squared_bits,
              proven_.kernel.worst_point);
    facts.add("certificate", "{}", certificate_path(output_).string());
  }

  void refuse(Facts& facts) const {
    const CertifiedError& points = result_.points;
    const double farthest = std::ranges::max(points.excluded_distances);
    facts.add(
        "result",
        "infeasible: {1} of {2} points are farther than {0:.9g} from the mesh, and no triangle "
        "could be added to reach them; the farthest is at {3:.9g} (point {4}); nothing is written",
        epsilon_, grouped(points.excluded.size()), grouped(pieces_->points()), farthest,
        scan().cloud.index_in_file(points.excluded[static_cast<std::size_t>(
            std::ranges::max_element(points.excluded_distances) -
            points.excluded_distances.begin())]));
    facts.add("", "raise --max-error or exclude points with --exclude-outliers");
  }

  void print_time(std::string_view remark) {
    facts_.add_passing("decimation", "{:.1f} s{}{}", progress_.seconds(), remark,
                       was_interrupted()     ? "; interrupted"
                       : result_.interrupted ? "; out of time"
                                             : "");
  }

  void write_json() const {
    if (!json_is_wanted(options_.json)) return;
    ResultReport report = emax::report_of(result());
    report.feasible = feasible_;
    report.reconstruction_triangles = given_.triangles.size();
    report.lost_attributes = lost_attributes_;
    report.device = "cpu";
    report.two_sided = options_.two_sided;
    report.page = options_.report.report;
    report.picture = options_.report.picture;
    emax::write_json(options_.json, to_json_text(report));
  }

  DecimationProgress progress_;
  const DecimateOptions& options_;
  Facts facts_;
  bool own_cloud_;
  std::uint64_t memory_;  // bytes
  double share_;
  std::vector<ToleratedMesh> bounds_;  // ascending
  std::filesystem::path output_;       // for the present tolerance
  std::optional<double> back_;         // --back-error, if it is given
  std::optional<double> hole_reach_;   // --hole-reach, if it is given
  TriangleMesh given_;
  std::vector<std::string> lost_attributes_;
  Scan vertices_ = {};  // of the mesh, where they are the cloud
  std::optional<ScanPieces> pieces_;
  std::size_t tile_triangles_ = 0;    // 0: the mesh is decimated as a whole
  std::optional<TileFolder> folder_;  // of tiles whose points are not in memory
  std::optional<TiledScan> tiled_;
  bool has_begun_ = false;
  std::string mesh_sha256_, cloud_sha256_;
  double epsilon_ = 0;
  CertifiedDecimationSettings settings_;
  MeshFormat format_ = MeshFormat::kPly;
  KeptPoints kept_;
  GivenReference reference_;
  std::optional<ReferenceFile> file_;  // of a two-sided bound
  CertifiedDecimation result_;
  ProvenMesh proven_;
  std::optional<ResultRegions> regions_;  // of the last result, with --features
  WrittenResult written_;                 // of the last result that keeps the bounds
  bool is_large_ = false;                 // so that the effort is quick
  bool feasible_ = false;
};

}  // namespace

int run_decimate(const DecimateOptions& options) { return DecimateCommand(options).run(); }

}  // namespace emax
