#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/app/commands.h"
#include "host/app/decimation_progress.h"
#include "host/app/fit_report.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/reference_text.h"
#include "host/decimate/certified_decimation.h"
#include "host/decimate/decimation_sequence.h"
#include "host/files/atomic_file.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/merge_vertices.h"
#include "host/measure/error_constraint.h"
#include "host/report/certificate_file.h"
#include "host/report/curve_svg.h"
#include "host/report/result_json.h"
#include "host/surface/close_holes.h"
#include "host/surface/manifold_part.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Effort = DecimationSettings::Effort;

Effort effort_named(const std::string& name) {
  return name == "quick" ? Effort::kCollapse : name == "deep" ? Effort::kDeep : Effort::kRelax;
}

constexpr double kAnyHole = 1;  // as wide as the mesh

// Tolerances as given, between commas, and the mesh that each is written to: where there are
// several, the output's name with the tolerance behind its stem (part-0.1pct.ply).
struct Bound {
  std::string text;
  Tolerance tolerance;
  std::filesystem::path output;
};

std::vector<Bound> bounds_of_options(const std::string& tolerances,
                                     const std::filesystem::path& output) {
  std::vector<Bound> bounds;
  for (std::size_t start = 0; start <= tolerances.size();) {
    const std::size_t end = std::min(tolerances.find(',', start), tolerances.size());
    const std::string text = tolerances.substr(start, end - start);
    bounds.push_back({text, parse_tolerance(text), output});
    start = end + 1;
  }
  if (bounds.size() == 1) return bounds;
  for (const Bound& bound : bounds) {
    if (std::ranges::count(bounds, bound.text, &Bound::text) > 1) {
      throw Error("--max-error: " + bound.text + " is given twice");
    }
  }
  for (Bound& bound : bounds) {
    std::string label = bound.text;
    if (bound.tolerance.percent) label.replace(label.size() - 1, 1, "pct");
    bound.output.replace_filename(output.stem().string() + "-" + label +
                                  output.extension().string());
  }
  return bounds;
}

std::filesystem::path curve_path(const std::filesystem::path& output) {
  std::filesystem::path path = output;
  return path.replace_filename(output.stem().string() + "-curve.svg");
}

class DecimateCommand {
 public:
  explicit DecimateCommand(const DecimateOptions& options)
      : progress_(options.seconds ? std::optional<std::chrono::duration<double>>(*options.seconds)
                                  : std::nullopt),
        options_(options),
        own_cloud_(options.cloud.empty()),
        share_(parse_share(options.excluded_share)),
        bounds_(bounds_of_options(options.max_error, options.output)),
        output_(bounds_.front().output) {
    const bool several = bounds_.size() > 1;
    if (several && share_ > 0) {
      throw Error("--exclude-outliers: give one --max-error, as each would exclude other points");
    }
    std::optional<Tolerance> back;
    if (!options.back_error.empty()) back = parse_tolerance(options.back_error, "--back-error");
    const std::filesystem::path curve = several ? curve_path(options.output) : "";
    for (const Bound& bound : bounds_) {
      check_mesh_outputs(bound.output, options.two_sided);
      check_distinct({bound.output, certificate_path(bound.output), options.json, curve},
                     {options.mesh, options.cloud});
    }
    if (!options.json.empty()) check_output(options.json, kJsonEndings);
    progress_.begin("reading", reading_seconds(options.mesh) +
                                   (own_cloud_ ? 0 : reading_seconds(options.cloud)));
    MeshFile file = read_mesh_file(options.mesh);
    given_ = std::move(file.mesh);
    lost_attributes_ = std::move(file.attributes);
    scan_ = own_cloud_ ? vertices_of(options.mesh, given_)
                       : read_scan(options.cloud, options.skip_invalid);
    drop_unused_vertices(given_.vertices, given_.triangles);
    // Of what was read: the files may change while the decimation runs.
    mesh_sha256_ = sha256_of_file(options.mesh);
    cloud_sha256_ = own_cloud_ ? mesh_sha256_ : sha256_of_file(scan_.path);
    if (back) back_ = below_width(*back, "--back-error", scan_);
    // The reference is the same for all of them, and has room for the smallest.
    std::ranges::sort(bounds_, {},
                      [&](const Bound& b) { return b.tolerance.in_units(scan_.width); });
    for (const Bound& bound : bounds_) below_width(bound.tolerance, "--max-error", scan_);
    set_bound(bounds_.front());
    settings_.decimation.two_sided = options.two_sided;
    settings_.decimation.effort = effort_named(options.effort);
    settings_.decimation.feature_angle = options.feature_angle;
    if (options.objective == "hoppe") {
      settings_.decimation.objective = DecimationSettings::Objective::kHoppe;
    }
    format_ = mesh_format(options.output);
    settings_.storage = storage_of(format_);
    require_storable(given_, format_, std::min(epsilon_, epsilon_back()), options.output);
  }

  int run() {
    progress_.finish();
    print_task();
    const std::size_t points = scan_.cloud.points.size();
    progress_.begin("making the reference surface", joining_seconds(points));
    const std::vector<std::uint32_t> outliers = farthest_beyond();
    std::vector<Point> kept;
    std::vector<std::uint32_t> index;  // of the kept points in the cloud
    for (std::uint32_t i = 0; i < scan_.cloud.points.size(); ++i) {
      if (std::ranges::binary_search(outliers, i)) continue;
      kept.push_back(scan_.cloud.points[i]);
      index.push_back(i);
    }
    make_reference(kept);
    if (was_interrupted()) throw Interrupted{};
    if (options_.two_sided && !given_is_reference()) {
      check_distinct({reference_file(), options_.json}, {options_.mesh, options_.cloud});
    }
    settings_.decimation.interrupted = [&] { return progress_.out_of_time() || was_interrupted(); };
    settings_.decimation.advanced = [&](double share, std::size_t triangles) {
      progress_.show(share, triangles);
    };
    if (bounds_.size() > 1) return run_sequence(kept);
    progress_.begin("assigning the points", joining_seconds(points));
    result_ = decimate_certified(reference_.mesh, kept, settings_);
    if (!outliers.empty()) {
      std::vector<std::uint32_t> excluded = outliers;
      for (const std::uint32_t i : result_.points.excluded) excluded.push_back(index[i]);
      std::ranges::sort(excluded);
      result_.points = certify(scan_.cloud.points, result_.mesh.view(), excluded);
    }
    progress_.begin("certifying the result", certifying_seconds(points));
    feasible_ = may_leave_out_own_vertices() || result_.points.excluded.size() <= excludable();
    kernel_ = kernel_error(scan_, result_.mesh.view(), result_.points.excluded);
    if (feasible_) {
      keep();
    } else {
      progress_.finish();
      refuse();
    }
    fmt::print(
        "decimation     {:.1f} s{}{}\n", progress_.seconds(),
        result_.repairs > 0
            ? fmt::format("; results that missed the bound and were corrected: {}", result_.repairs)
            : "",
        was_interrupted()     ? "; interrupted"
        : result_.interrupted ? "; out of time"
                              : "");
    write_json();
    if (was_interrupted()) return kExitInterrupted;
    return feasible_ && all_closed() ? kExitOk : kExitNo;
  }

 private:
  void set_bound(const Bound& bound) {
    output_ = bound.output;
    epsilon_ = bound.tolerance.in_units(scan_.width);
    settings_.decimation.epsilon = epsilon_;
    settings_.decimation.epsilon_back = back_.value_or(epsilon_);
  }

  // A mesh for each bound, the smallest first, from one sequence of collapses.
  int run_sequence(const std::vector<Point>& kept) {
    DecimationSequence sequence(reference_.mesh, kept);
    std::vector<CurvePoint> curve;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    const bool percent =
        std::ranges::all_of(bounds_, [](const Bound& b) { return b.tolerance.percent; });
    bool all_feasible = true;
    std::string table;
    for (const Bound& bound : bounds_) {
      set_bound(bound);
      progress_.begin("assigning the points", joining_seconds(kept.size()));
      result_ = decimate_certified(
          reference_.mesh, kept, settings_,
          [&](const DecimationSettings& settings) { return sequence.cut(settings); });
      progress_.begin("certifying the result", certifying_seconds(kept.size()));
      kernel_ = kernel_error(scan_, result_.mesh.view(), result_.points.excluded);
      const bool feasible = may_leave_out_own_vertices() || result_.points.excluded.empty();
      all_feasible = all_feasible && feasible;
      if (feasible) {
        write();
        curve.push_back(
            {percent ? bound.tolerance.value : epsilon_, result_.mesh.triangles.size()});
      }
      progress_.finish();
      table += fmt::format("  {:<12} {:>12.6g} {:>10} {:>12.6g}  {}\n", bound.text, epsilon_,
                           feasible ? grouped(result_.mesh.triangles.size()) : "-",
                           result_.points.e_max_upper, feasible ? output_.string() : "infeasible");
      rows.push_back({{"max_error", bound.text},
                      {"epsilon", epsilon_},
                      {"feasible", feasible},
                      {"triangles", result_.mesh.triangles.size()},
                      {"e_max", result_.points.e_max_upper},
                      {"mesh", feasible ? nlohmann::ordered_json(output_.string()) : nullptr}});
      if (was_interrupted() || result_.interrupted) break;
    }
    print_reference();
    fmt::print("  {:<12} {:>12} {:>10} {:>12}  {}\n{}", "--max-error", "tolerance", "triangles",
               "e_max", "mesh, with its certificate beside it", table);
    if (curve.size() > 1) {
      const std::filesystem::path picture = curve_path(options_.output);
      write_atomically(picture,
                       curve_svg(curve, percent ? "% of the width" : "the unit of the points"));
      fmt::print("curve          {}\n", picture.string());
    }
    fmt::print("decimation     {:.1f} s{}\n", progress_.seconds(),
               was_interrupted()     ? "; interrupted"
               : result_.interrupted ? "; out of time"
                                     : "");
    if (json_is_wanted(options_.json)) {
      const nlohmann::ordered_json json = {
          {"schema", "emax-curve-1"}, {"mesh", options_.mesh}, {"curve", rows}};
      emax::write_json(options_.json, json.dump(2) + "\n");
    }
    if (was_interrupted()) return kExitInterrupted;
    return all_feasible && curve.size() == bounds_.size() && all_closed() ? kExitOk : kExitNo;
  }

  // That was asked for.
  bool all_closed() const { return !closed_ || closed_->open.empty(); }
  double epsilon_back() const { return settings_.decimation.epsilon_back; }
  std::size_t excludable() const { return excludable_points(share_, scan_.cloud.points.size()); }
  // The vertices of triangles that were removed are no part of the surface that is left.
  bool may_leave_out_own_vertices() const { return own_cloud_ && reference_.dropped > 0; }
  // Those that may be excluded, in order.
  std::vector<std::uint32_t> farthest_beyond() const {
    if (excludable() == 0) return {};
    const ExactMesh exact(given_.view());
    std::vector<std::pair<double, std::uint32_t>> beyond;
    for (std::uint32_t i = 0; i < scan_.cloud.points.size(); ++i) {
      const double distance = exact.distance(scan_.cloud.points[i]).upper;
      if (distance > epsilon_) beyond.emplace_back(-distance, i);
    }
    std::ranges::sort(beyond);
    beyond.resize(std::min(beyond.size(), excludable()));
    std::vector<std::uint32_t> points;
    for (const auto& [distance, i] : beyond) points.push_back(i);
    std::ranges::sort(points);
    return points;
  }
  double percent(double length) const { return 100 * length / scan_.width; }

  // The reference is the mesh as it was given, but for its order.
  bool given_is_reference() const {
    const ReferenceSurface& r = reference_;
    return !options_.repair && !closed_ && r.merged == 0 && r.turned == 0 && r.dropped == 0 &&
           r.split == 0 && r.cut_vertices == 0 && r.inserted == 0;
  }
  std::filesystem::path reference_file() const {
    if (given_is_reference()) return options_.mesh;
    return reference_path(options_.output);
  }

  // The mesh as it was given, cut apart where it is not manifold; or repaired.
  void make_reference(std::span<const Point> kept) {
    if (!options_.repair) {
      if (!options_.closed) {
        reference_ = reference_surface(given_, kept, epsilon_ / 2, was_interrupted,
                                       MadeManifold::kByCutting);
        return;
      }
      CutSurface cut = cut_to_manifold(given_);
      closed_ = close_surface(std::move(cut.mesh));
      reference_ = reference_surface(closed_->mesh, kept, epsilon_ / 2, was_interrupted,
                                     MadeManifold::kByCutting);
      reference_.merged += cut.merged;
      reference_.turned += cut.turned;
      reference_.dropped += cut.dropped;
      reference_.split += cut.split;
      reference_.cut_edges += cut.cut_edges;
      reference_.cut_vertices += cut.cut_vertices;
      return;
    }
    before_repair_ = topology_of(cut_to_manifold(given_).mesh.view());
    ManifoldPart part = manifold_part(given_);
    if (before_repair_->border_loops == 0 && !part.mesh.triangles.empty()) {
      ClosedHoles closed = close_holes(std::move(part.mesh), kAnyHole);
      part.mesh = std::move(closed.mesh);
      part.dropped += closed.dropped;
    }
    if (options_.closed) {
      closed_ = close_surface(std::move(part.mesh));
      part.mesh = closed_->mesh;
    }
    reference_ = reference_surface(part.mesh, kept, epsilon_ / 2, was_interrupted);
    reference_.dropped += part.dropped;
  }

  void print_reference() const {
    if (given_is_reference()) return;
    const ReferenceSurface& r = reference_;
    std::string made;
    const auto say = [&](std::size_t count, std::string_view what, std::string_view then) {
      if (count == 0) return;
      made += fmt::format("{}{} {} {}", made.empty() ? "" : ", ", grouped(count), what, then);
    };
    say(r.merged, r.merged == 1 ? "vertex" : "vertices", "merged with others at the same place");
    say(r.turned, r.turned == 1 ? "triangle" : "triangles", "turned to agree with the others");
    say(r.dropped, r.dropped == 1 ? "triangle" : "triangles",
        options_.repair ? "removed (degenerate, not manifold or intersecting others)"
                        : "removed (degenerate or repeated)");
    say(r.split, r.split == 1 ? "triangle" : "triangles", "split at vertices on their sides");
    say(r.cut_edges, r.cut_edges == 1 ? "non-manifold edge" : "non-manifold edges", "cut apart");
    say(r.cut_vertices, r.cut_vertices == 1 ? "non-manifold vertex" : "non-manifold vertices",
        "cut apart");
    say(r.inserted, r.inserted == 1 ? "point" : "points", "added that the mesh missed");
    fmt::print("reference      {}{}\n", made.empty() ? "as given" : made,
               options_.two_sided ? ": " + reference_file().string() : "");
    if (closed_) print_closed(closed_->closed, closed_->open);
    if (!before_repair_) return;
    const bool was_closed = before_repair_->border_loops == 0;
    const MeshTopology now = topology_of(reference_.mesh.view());
    fmt::print("repaired       {}{}; now {}\n", describe(*before_repair_),
               was_closed && now.border_loops > 0 ? "; was closed, now open" : "", describe(now));
  }

  void print_task() const {
    fmt::print("mesh           {}: {} triangles\n", options_.mesh,
               grouped(given_.triangles.size()));
    if (!lost_attributes_.empty()) {
      fmt::print("not kept       {}: the result holds vertices and triangles alone\n",
                 fmt::join(lost_attributes_, ", "));
    }
    fmt::print("points         {}: {}{}, width {:.6g}\n", scan_.path.string(),
               grouped(scan_.cloud.points.size()), own_cloud_ ? " vertices" : "", scan_.width);
    std::string tolerances;
    for (const Bound& bound : bounds_) {
      if (bounds_.size() == 1) {
        tolerances = to_text(bound.tolerance, scan_.width);
      } else {
        tolerances += (tolerances.empty() ? "" : ", ") + bound.text;
      }
    }
    fmt::print("tolerance      {}, {}", tolerances, options_.two_sided ? "two-sided" : "one-sided");
    if (options_.two_sided && epsilon_back() != epsilon_) {
      fmt::print(", mesh to reference {:.6g}", epsilon_back());
    }
    fmt::print("\n");
    std::fflush(stdout);
  }

  void keep() {
    write();
    progress_.finish();
    print_result();
  }

  void write() {
    const std::string bytes = mesh_bytes(result_.mesh, format_);
    Certificate certificate;
    certificate.mesh_file = output_.filename().string();
    certificate.mesh_sha256 = sha256(bytes);
    certificate.cloud_file = scan_.path.filename().string();
    certificate.cloud_sha256 = cloud_sha256_;
    certificate.skip_invalid = options_.skip_invalid;
    certificate.vertices_of_mesh = own_cloud_;
    certificate.epsilon = epsilon_;
    certificate.error = in_file_indices(result_.points, scan_.cloud);
    certificate.kernel = kernel_;
    certificate.vertices = result_.mesh.vertices.size();
    certificate.triangles = result_.mesh.triangles.size();
    certificate.validity = result_.validity;
    certificate.topology = topology_of(result_.mesh.view());
    certificate.transform = normalization_of(scan_.cloud.points);
    certificate.chain = {"none",
                         "bounded",
                         {{kBoundedEffort, static_cast<double>(settings_.decimation.effort)},
                          {"bounded.feature_angle", settings_.decimation.feature_angle}}};
    if (options_.objective == "hoppe") certificate.chain.parameters["bounded.hoppe"] = 1;
    std::vector<OutputFile> files;
    if (options_.two_sided) {
      std::string sum;
      if (given_is_reference()) {
        sum = mesh_sha256_;
      } else {
        files.push_back({reference_file(), mesh_bytes(reference_.mesh, MeshFormat::kPly)});
        sum = sha256(files.back().bytes);
      }
      certificate.reference = reference_bound_ = bound(std::move(sum));
    }
    files.push_back({output_, bytes});
    files.push_back({certificate_path(output_), to_json_text(certificate)});
    write_together(files);
  }

  ReferenceBound bound(std::string sum) const {
    ReferenceBound reference;
    reference.file = reference_file().filename().string();
    reference.sha256 = std::move(sum);
    reference.triangles = reference_.mesh.triangles.size();
    reference.epsilon_back = epsilon_back();
    reference.mesh_to_reference = result_.mesh_to_reference->upper;
    reference.topology = topology_of(reference_.mesh.view());
    reference.reference_to_mesh = result_.reference_to_mesh->upper;
    reference.points_to_reference =
        certify(scan_.cloud.points, reference_.mesh.view(), result_.points.excluded).e_max_upper;
    return reference;
  }

  void print_result() const {
    print_reference();
    fmt::print("result         {}: {} triangles; {}\n", output_.string(),
               grouped(result_.mesh.triangles.size()), describe(result_.validity));
    fmt::print(
        "topology       {}\n",
        describe(topology_of(result_.mesh.view()),
                 reference_bound_ ? std::optional(reference_bound_->topology) : std::nullopt));
    fmt::print(
        "e_max          {:.9g} certified, at most {:.9g} ({:.4g}% of the width): every point to "
        "the mesh\n",
        result_.points.e_max_upper, epsilon_, percent(result_.points.e_max_upper));
    if (reference_bound_) print(*reference_bound_, epsilon_, scan_.width, reference_file());
    if (!may_leave_out_own_vertices()) {
      print_excluded(result_.points, excludable());
    } else if (!result_.points.excluded.empty()) {
      fmt::print(
          "left out       vertices of removed triangles: {}, up to {:.9g} from the result; the "
          "certificate names them\n",
          grouped(result_.points.excluded.size()), result_.points.e_max_upper_all);
    }
    fmt::print("kernel         e_max^2 bits 0x{:08x} at point {}\n", kernel_.squared_bits,
               kernel_.worst_point);
    fmt::print("certificate    {}\n", certificate_path(output_).string());
  }

  void refuse() const {
    const CertifiedError& points = result_.points;
    const double farthest = std::ranges::max(points.excluded_distances);
    fmt::print(
        "result         infeasible: farther than {:.9g} from the mesh, out of reach of triangles "
        "that could be added: {} of {} points, the farthest {:.9g} (point {}); nothing is "
        "written\n",
        epsilon_, grouped(points.excluded.size()), grouped(scan_.cloud.points.size()), farthest,
        scan_.cloud.index_in_file(points.excluded[static_cast<std::size_t>(
            std::ranges::max_element(points.excluded_distances) -
            points.excluded_distances.begin())]));
    fmt::print("               raise --max-error or allow for them with --exclude-outliers\n");
  }

  void write_json() const {
    if (!json_is_wanted(options_.json)) return;
    ResultReport report;
    report.feasible = feasible_;
    report.validity = result_.validity;
    report.topology = topology_of(result_.mesh.view());
    report.triangles = result_.mesh.triangles.size();
    report.epsilon = epsilon_;
    report.certified = in_file_indices(result_.points, scan_.cloud);
    report.kernel = kernel_;
    report.points = scan_.cloud.points.size();
    report.transform = normalization_of(scan_.cloud.points);
    report.reconstruction_triangles = given_.triangles.size();
    report.lost_attributes = lost_attributes_;
    report.device = "cpu";
    report.two_sided = options_.two_sided;
    report.reference = reference_bound_;
    emax::write_json(options_.json, to_json_text(report));
  }

  DecimationProgress progress_;
  const DecimateOptions& options_;
  bool own_cloud_;
  double share_;
  std::vector<Bound> bounds_;     // ascending
  std::filesystem::path output_;  // of the bound at hand
  std::optional<double> back_;    // of the other direction, where it has one of its own
  TriangleMesh given_;
  std::vector<std::string> lost_attributes_;
  Scan scan_;
  std::string mesh_sha256_, cloud_sha256_;
  double epsilon_ = 0;
  CertifiedDecimationSettings settings_;
  MeshFormat format_ = MeshFormat::kPly;
  ReferenceSurface reference_;
  std::optional<MeshTopology> before_repair_;
  std::optional<ClosedSurface> closed_;  // where that was asked for
  CertifiedDecimation result_;
  EmaxResult kernel_ = {};  // the point is the file's
  std::optional<ReferenceBound> reference_bound_;
  bool feasible_ = false;
};

}  // namespace

int run_decimate(const DecimateOptions& options) { return DecimateCommand(options).run(); }

}  // namespace emax
