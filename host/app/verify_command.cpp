#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "host/app/checked_claims.h"
#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/measured_mesh.h"
#include "host/app/point_claims.h"
#include "host/app/reference_text.h"
#include "host/app/report_output.h"
#include "host/files/atomic_file.h"
#include "host/files/input_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/files/spooled_input.h"
#include "host/parameters/decimation_bound.h"
#include "host/report/certificate_file.h"
#include "host/report/verification_json.h"
#include "host/tiles/partwise_check.h"
#include "host/tiles/partwise_surfaces.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {
namespace {

// The file as named, or beside the certificate, or (if `also_here`) in the current folder.
std::filesystem::path locate(const std::string& named, const std::string& file, const char* option,
                             const std::filesystem::path& certificate, bool also_here) {
  if (!named.empty()) return named;
  if (file == kStandardInput) {
    throw Error(fmt::format("{}: was made from standard input; name a file of the same with --{}",
                            certificate.string(), option));
  }
  std::filesystem::path beside = certificate.parent_path() / file;
  if (std::filesystem::exists(beside)) return beside;
  if (also_here && std::filesystem::exists(file)) return file;
  throw Error(fmt::format("{}: its {} is not found; name it with --{}", certificate.string(), file,
                          option));
}

// Another build may round the last bit differently.
bool agree(double claimed, double found) {
  return std::abs(claimed - found) <= 1e-12 * std::abs(found);
}

void throw_if_interrupted() {
  if (was_interrupted()) throw Interrupted{};
}

class Verification {
 public:
  explicit Verification(const VerifyOptions& options)
      : path_(options.certificate),
        certificate_(read_certificate(path_)),
        report_(options.report),
        memory_(options.memory.value_or(standard_memory())),
        runner_(options.machines.pieces) {
    if (!options.report.report.empty()) certificate_text_ = read_input(path_).bytes;
    mesh_path_ = locate(options.mesh, certificate_.mesh_file, "mesh", path_, false);
    cloud_path_ = locate(options.cloud, certificate_.cloud_file, "cloud", path_, true);
    if (certificate_.reference) {
      reference_path_ =
          locate(options.reference, certificate_.reference->file, "reference", path_, true);
    }
  }

  // Of a certificate whose mesh, cloud and reference are at hand.
  Verification(const Certificate& certificate, const TriangleMesh& mesh, const Scan& scan,
               const TriangleMesh* reference)
      : certificate_(certificate) {
    mesh_.emplace(mesh);
    scan_.emplace(scan);
    if (reference != nullptr) reference_.emplace(*reference);
  }

  // Throws Error if an output is one of the files that are read.
  void require_apart(const VerifyOptions& options) const {
    check_distinct({options.json, options.report.report, options.report.picture},
                   {path_, mesh_path_, cloud_path_, reference_path_});
  }

  // The JSON of the results of run().
  std::string json_text(const ReportOptions& report) const {
    return to_json_text({.certificate_file = path_.string(),
                         .mesh_file = mesh_path_.string(),
                         .cloud_file = cloud_path_.string(),
                         .reference_file = reference_path_.string(),
                         .page = report.report,
                         .picture = report.picture,
                         .certificate = &certificate_,
                         .e_max = e_max_,
                         .reasons = reasons_});
  }

  CheckedClaims run() {
    check_files();
    if (!reasons_.empty()) return {reasons_, e_max_};
    read();
    return check();
  }

  // Recomputes the claims.
  CheckedClaims check() {
    require_resolution(scan_->scan(), certificate_.epsilon);
    excluded_ = certificate_.error.excluded;
    std::ranges::sort(excluded_);
    const bool once = std::ranges::adjacent_find(excluded_) == excluded_.end();
    const bool leave_some = excluded_.size() < scan_->points();
    if (once && leave_some) {
      recompute_points();
    }
    if (mesh_->is_whole()) {
      found_.triangles = mesh().triangles.size();
      found_.vertices = mesh().vertices.size();
    } else {
      found_ = mesh_->check(processor_threads(), was_interrupted);
    }
    check_sizes(once, leave_some);
    if (reasons_.empty()) check_claims();
    return {reasons_, e_max_};
  }

  // Prints the answer.
  bool report() const {
    if (reasons_.empty()) {
      print_what_holds();
      return true;
    }
    for (const std::string& reason : reasons_) fmt::print("no: {}\n", reason);
    return false;
  }

  void write_report_of(const ReportOptions& wanted, double seconds) {
    if (!wanted.any()) return;
    if (!scan_) read();  // other files than those that were certified are shown as they are
    if (!excluded_are_known_) excluded_.clear();
    const Scan& scan = scan_->scan();
    ReportData report = measured_report(wanted, scan, mesh_->whole().view(),
                                        in_cloud(excluded_, scan.cloud), certificate_.epsilon);
    const DeviationStatistics& s = report.measured.statistics;
    report.command = "verify";
    report.title = path_.filename().string();
    if (!certificate_.unit.empty()) report.unit = certificate_.unit;
    report.within = reasons_.empty();
    report.verdict = verdict();
    report.e_max = e_max_.value_or(std::max(std::abs(s.min), std::abs(s.max)));
    if (certificate_.reference) report.back = certificate_.reference->mesh_to_reference;
    report.provenance = inputs_;
    report.certificate = {path_.filename().string(), certificate_text_,
                          "emax verify " + shell_word(path_.string())};
    report.checks = checks_;
    report.times.push_back({"verification", seconds});
    Facts facts;
    write_report(wanted, std::move(report), facts);
  }

 private:
  // Adds to the reasons if the claim does not hold. Claims of one name are one check of the report.
  void require(std::string_view claim, bool holds, std::string otherwise) {
    if (checks_.empty() || checks_.back().claim != claim) {
      checks_.push_back({std::string(claim), true, ""});
    }
    if (holds) return;
    ReportCheck& check = checks_.back();
    check.text = (check.holds ? "" : check.text + "; ") + otherwise;
    check.holds = false;
    reasons_.push_back(std::move(otherwise));
  }

  // The sentence of the report for the last claim, if it holds.
  void say(std::string text) {
    if (checks_.back().holds) checks_.back().text = std::move(text);
  }

  void check_files() {
    const auto check = [&](const char* name, const std::filesystem::path& file,
                           const std::string& claimed) {
      inputs_.push_back(report_input(name, file, sha256_of_input(file)));
      require("files", inputs_.back().sha256 == claimed,
              fmt::format("{} is not the {} that was certified (SHA-256)", file.string(), name));
    };
    check("mesh", mesh_path_, certificate_.mesh_sha256);
    check("cloud", cloud_path_, certificate_.cloud_sha256);
    if (certificate_.reference) check("reference", reference_path_, certificate_.reference->sha256);
    say("the files are those that were certified (SHA-256)");
  }

  void read() {
    // A mesh is compared with its reference as a whole, and a report shows the whole mesh.
    if (certificate_.reference || report_.any()) {
      mesh_.emplace(read_mesh(mesh_path_));
    } else {
      mesh_.emplace(mesh_path_, memory_);
    }
    std::uint64_t memory_for_points = mesh_->is_whole() ? memory_ : mesh_->memory_for_points();
    if (certificate_.reference) {
      reference_.emplace(reference_path_, memory_for_reference());
      if (!reference_->is_whole()) memory_for_points = reference_->memory_for_points();
    }
    if (!mesh_->is_whole()) runner_ = std::make_shared<LocalPieces>();
    if (certificate_.vertices_of_mesh) {
      vertices_ = vertices_of(cloud_path_, read_mesh(cloud_path_));
      scan_.emplace(*vertices_);
    } else {
      scan_.emplace(cloud_path_, certificate_.reading, "", memory_for_points, was_interrupted,
                    runner_->threads(cloud_path_, files()));
      scan_->require_in_memory(report_);
    }
  }

  // What the mesh leaves, which is held.
  std::uint64_t memory_for_reference() const {
    constexpr std::uint64_t kBytesHeld = 256, kLeast = 100'000'000;
    const std::uint64_t held = std::min(memory_, kBytesHeld * mesh().triangles.size());
    return std::max(memory_ - held, std::min(memory_, kLeast));
  }

  void recompute_points() {
    const bool in_parts = reference_ && !reference_->is_whole();
    points_ = recompute(*scan_, *mesh_, reference_ && !in_parts ? &reference_->whole() : nullptr,
                        excluded_, *runner_, files(), memory_ / 8);
    if (!in_parts) return;
    LocalPieces here;
    points_->of_reference =
        recompute(*scan_, *reference_, nullptr, excluded_, here, {}, memory_ / 8).error;
  }

  const TriangleMesh& mesh() const { return mesh_->whole(); }

  // Those that other processes hold as a whole.
  MeterFiles files() const {
    const bool is_whole = !reference_ || reference_->is_whole();
    return {mesh_path_, is_whole ? reference_path_ : std::filesystem::path()};
  }

  void check_sizes(bool once, bool leave_some) {
    require(
        "sizes",
        found_.triangles == certificate_.triangles && found_.vertices == certificate_.vertices,
        fmt::format("the mesh has {} triangles and {} vertices, not {} and {}", found_.triangles,
                    found_.vertices, certificate_.triangles, certificate_.vertices));
    const bool exist = !points_ || points_->excluded == excluded_.size();
    require("sizes", exist, "the certificate excludes a point that the cloud does not have");
    require("sizes", once, "the certificate excludes a point twice");
    require("sizes", leave_some, "the certificate excludes every point");
    excluded_are_known_ = exist && once && leave_some;
    say(fmt::format("the mesh has {} triangles, the cloud {} points, {} of them excluded",
                    grouped(certificate_.triangles), grouped(scan_->points()),
                    excluded_.empty() ? "none" : grouped(excluded_.size())));
  }

  void check_claims() {
    check_error();
    check_kernel();
    if (certificate_.reference) check_reference();
    if (mesh_->is_whole()) {
      found_.validity = check_mesh(mesh().view(), processor_threads());
      found_.topology = topology_of(mesh().view());
    }
    const MeshValidity& validity = found_.validity;
    require("validity",
            validity == certificate_.validity && validity.valid() == certificate_.claims_valid,
            "the mesh's validity differs");
    say("the mesh is " + describe(validity));
    check_topology("the mesh", certificate_.topology, found_.topology);
    const Normalization transform = scan_->normalization();
    require("transform",
            transform.origin == certificate_.transform.origin &&
                transform.scale == certificate_.transform.scale,
            "the certificate's transform is not that of the cloud");
    say("the certificate's transform is that of the cloud");
  }

  std::string verdict() const {
    if (!reasons_.empty()) return "The certificate does not hold: " + reasons_.front() + ".";
    std::string length = fmt::format("{:.9g}", certificate_.epsilon);
    if (!certificate_.unit.empty()) length += " " + certificate_.unit;
    return fmt::format("The certificate holds: every {}point lies within {} of the mesh.",
                       certificate_.error.excluded.empty() ? "" : "kept ", length);
  }

  void check_topology(const char* what, const MeshTopology& claimed, const MeshTopology& found) {
    require(std::string("topology of ") + what, claimed == found,
            fmt::format("the certificate claims {} for {}, which has {}", describe(claimed), what,
                        describe(found)));
    say(fmt::format("{} has {}", what, describe(found)));
  }

  void check_error() {
    const CertifiedError& error = points_->error;
    const CertifiedError& claimed = certificate_.error;
    require(
        "points", error.within(certificate_.epsilon),
        fmt::format("e_max is {:.9g}, more than {:.9g}", error.e_max_upper, certificate_.epsilon));
    // Another build may round the last bit differently, but a claim below the exact value is false.
    require("points",
            claimed.e_max_upper >= error.e_max_lower && claimed.e_max_upper <= certificate_.epsilon,
            fmt::format("the certificate claims e_max {:.9g}, but it is {:.9g}",
                        claimed.e_max_upper, error.e_max_upper));
    require("points", claimed.points == error.points,
            fmt::format("the certificate counts {} points, but {} are kept", claimed.points,
                        error.points));
    for (std::size_t i = 0; i < claimed.excluded.size(); ++i) {
      const auto at = std::ranges::lower_bound(error.excluded, claimed.excluded[i]);
      const double found =
          error.excluded_distances[static_cast<std::size_t>(at - error.excluded.begin())];
      require(
          "points", agree(claimed.excluded_distances[i], found),
          fmt::format(
              "the certificate claims {:.9g} for the distance of the excluded point {}, which is "
              "{:.9g}",
              claimed.excluded_distances[i], claimed.excluded[i], found));
    }
    require("points", agree(claimed.e_max_upper_all, error.e_max_upper_all),
            fmt::format("the certificate claims e_max {:.9g} over all points, but it is {:.9g}",
                        claimed.e_max_upper_all, error.e_max_upper_all));
    e_max_ = error.e_max_upper;
    say(fmt::format("every {}point lies within {:.9g} of the mesh: e_max {:.9g}",
                    excluded_.empty() ? "" : "kept ", certificate_.epsilon, *e_max_));
  }

  void check_kernel() {
    const EmaxResult worst = points_->kernel;
    require("kernel",
            worst.squared_bits == certificate_.kernel.squared_bits &&
                worst.worst_point == certificate_.kernel.worst_point,
            fmt::format("the kernel gives 0x{:08x} at point {}, not 0x{:08x} at point {}",
                        worst.squared_bits, worst.worst_point, certificate_.kernel.squared_bits,
                        certificate_.kernel.worst_point));
    say(fmt::format("the kernel gives e_max^2 bits 0x{:08x} at point {}", worst.squared_bits,
                    worst.worst_point));
  }

  MeshConnectivity connectivity_of_reference() const {
    if (!reference_->is_whole()) {
      return connectivity_in_parts(reference_->parts(), reference_->memory_for_parts(),
                                   was_interrupted);
    }
    const TriangleMesh& whole = reference_->whole();
    return {{}, topology_of(whole.view()), whole.triangles.size(), whole.vertices.size()};
  }

  // Whether the distance of the mesh to the reference, or that of the reference to the mesh, is
  // within the claim.
  SurfaceDistance decided(bool to_reference, double claim) const {
    const MeasuredMesh& reference = *reference_;
    if (reference.is_whole()) {
      const TriangleMesh& from = to_reference ? mesh() : reference.whole();
      const TriangleMesh& to = to_reference ? reference.whole() : mesh();
      return decided_distance(from.view(), ExactMesh(to.view()), claim);
    }
    const PartwiseSurfaceOptions options = {.limit = claim,
                                            .memory = reference.memory_for_parts(),
                                            .threads = processor_threads(),
                                            .poll = throw_if_interrupted};
    if (to_reference) return distance_to_parts(mesh().view(), reference.parts(), options);
    return distance_from_parts(reference.parts(), ExactMesh(mesh().view()), options);
  }

  void check_distance(const char* what, bool to_reference, double claim, double limit) {
    require(what, claim >= 0 && claim <= limit,
            fmt::format("the certificate claims {:.9g} for {}, not within 0 and {:.9g}", claim,
                        what, limit));
    if (!(claim >= 0)) return;
    const SurfaceDistance found = decided(to_reference, claim);
    // A claim that holds may stay undecided because of roundings.
    require(what, found.lower <= claim && found.within(limit),
            fmt::format("the certificate claims {:.9g} for {}, which lies within {:.9g} and {:.9g}",
                        claim, what, found.lower, found.upper));
    say(fmt::format("{} is at most {:.9g}, {:.9g} is allowed", what, claim, limit));
  }

  void check_reference() {
    const ReferenceBound& claimed = *certificate_.reference;
    const MeshConnectivity found = connectivity_of_reference();
    require(
        "size of the reference", found.triangles == claimed.triangles,
        fmt::format("the reference has {} triangles, not {}", found.triangles, claimed.triangles));
    say(fmt::format("the reference has {} triangles", grouped(claimed.triangles)));
    check_distance("the distance of the mesh to the reference", true, claimed.mesh_to_reference,
                   claimed.epsilon_back);
    check_distance("the distance of the reference to the mesh", false, claimed.reference_to_mesh,
                   certificate_.epsilon);
    check_topology("the reference", claimed.topology, found.topology);
    const CertifiedError& own = *points_->of_reference;
    require(
        "the distance of the points to the reference",
        claimed.points_to_reference >= own.e_max_lower,
        fmt::format(
            "the certificate claims {:.9g} for the distance of the points to the reference, which "
            "is {:.9g}",
            claimed.points_to_reference, own.e_max_upper));
    say(fmt::format("the distance of the points to the reference is at most {:.9g}",
                    claimed.points_to_reference));
  }

  void print_what_holds() const {
    const CertifiedError& error = certificate_.error;
    fmt::print("yes: every {}point of {} lies within {:.9g} of {} (e_max {:.9g}, {} triangles)\n",
               error.excluded.empty() ? "" : "kept ", cloud_path_.string(), certificate_.epsilon,
               mesh_path_.string(), *e_max_, grouped(certificate_.triangles));
    if (!error.excluded.empty()) {
      fmt::print("     {} of its {} points are excluded, the farthest at {:.9g}\n",
                 grouped(error.excluded.size()), grouped(error.points + error.excluded.size()),
                 std::ranges::max(error.excluded_distances));
    }
    if (certificate_.reference) {
      const ReferenceBound& reference = *certificate_.reference;
      fmt::print("yes: all of {} lies within {:.9g} of {} (at most {:.9g})\n", mesh_path_.string(),
                 reference.epsilon_back, reference_path_.string(), reference.mesh_to_reference);
      if (reference.reference_to_mesh <= certificate_.epsilon) {
        fmt::print("yes: all of {} lies within {:.9g} of {} (at most {:.9g})\n",
                   reference_path_.string(), certificate_.epsilon, mesh_path_.string(),
                   reference.reference_to_mesh);
      } else {
        fmt::print("     all of {} lies within {:.9g} of {}, which the certificate leaves open\n",
                   reference_path_.string(), reference.reference_to_mesh, mesh_path_.string());
      }
    }
    fmt::print("yes: {} has {}\n", mesh_path_.string(),
               describe(certificate_.topology, certificate_.reference
                                                   ? std::optional(certificate_.reference->topology)
                                                   : std::nullopt));
  }

  std::filesystem::path path_;
  Certificate certificate_;
  std::string certificate_text_;
  std::filesystem::path mesh_path_, cloud_path_, reference_path_;
  std::optional<MeasuredMesh> mesh_;
  PartwiseCheck found_;  // of the mesh
  std::optional<MeasuredMesh> reference_;
  ReportOptions report_;
  std::uint64_t memory_ = 0;  // bytes
  std::shared_ptr<PieceRunner> runner_ = std::make_shared<LocalPieces>();
  std::optional<Scan> vertices_;         // of the mesh that is the cloud
  std::optional<ScanPieces> scan_;       // read with the meshes
  std::vector<std::uint32_t> excluded_;  // numbers in the file, ascending
  std::optional<PointClaims> points_;
  bool excluded_are_known_ = false;
  std::vector<ReportInput> inputs_;
  std::vector<ReportCheck> checks_;
  std::optional<double> e_max_;
  std::vector<std::string> reasons_;
};

}  // namespace

CheckedClaims check_files(const VerifyOptions& options) { return Verification(options).run(); }

CheckedClaims check_claims(const Certificate& certificate, const TriangleMesh& mesh,
                           const Scan& scan, const TriangleMesh* reference) {
  return Verification(certificate, mesh, scan, reference).check();
}

int run_verify(const VerifyOptions& options) {
  if (!options.json.empty()) check_output(options.json, kJsonEndings);
  check_report_outputs(options.report);
  const auto begun = std::chrono::steady_clock::now();
  Verification verification(options);
  verification.require_apart(options);
  verification.run();
  const bool holds = verification.report();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  verification.write_report_of(options.report, took.count());
  if (json_is_wanted(options.json)) {
    write_json(options.json, verification.json_text(options.report));
  }
  return holds ? kExitOk : kExitNo;
}

}  // namespace emax
