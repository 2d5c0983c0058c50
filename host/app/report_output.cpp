#include "host/app/report_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "host/app/scan.h"
#include "host/files/atomic_file.h"
#include "host/files/scan_folder.h"
#include "host/files/tolerance.h"
#include "host/report/report_page.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::array<std::string_view, 1> kReportEndings = {".html"};
constexpr std::array<std::string_view, 1> kPictureEndings = {".png"};

std::string verdict_of(const CertifiedResult& result, bool feasible) {
  const ProvenMesh& proven = result.proven;
  const auto length = [&](double value) { return length_text(value, result.cloud.scan.unit); };
  if (feasible) {
    std::string text =
        fmt::format("Within tolerance: every {}point lies within {} of the mesh",
                    proven.points.excluded.empty() ? "" : "kept ", length(result.epsilon));
    if (proven.reference) {
      text += fmt::format(", and all of the mesh within {} of the reference surface",
                          length(proven.reference->epsilon_back));
    }
    return text + ".";
  }
  if (proven.points.within(result.epsilon)) {
    return "Not within tolerance: the points are, but another bound is broken.";
  }
  return fmt::format(
      "Not within tolerance: the farthest point lies {} from the mesh, {} is allowed.",
      length(proven.points.e_max_upper), length(result.epsilon));
}

// The command that verifies a certificate from the folder in which this command runs. The cloud and
// a reference that is given are named where they are not found by themselves.
std::string verify_command(const CertifiedResult& result,
                           const std::filesystem::path& certificate) {
  std::string command = "emax verify " + shell_word(certificate.string());
  const std::filesystem::path& cloud = result.cloud.scan.path;
  const auto is_found = [&](const std::filesystem::path& file) {
    return !file.has_parent_path() || file.parent_path() == certificate.parent_path();
  };
  if (!is_found(cloud)) command += " --cloud " + shell_word(cloud.string());
  const std::filesystem::path& reference = result.proven.reference_path;
  if (!reference.empty() && !is_found(reference)) {
    command += " --reference " + shell_word(reference.string());
  }
  return command;
}

std::string value_text(const Parameter* parameter, double value) {
  if (parameter != nullptr && !parameter->categories.empty()) {
    const auto i = static_cast<std::size_t>(value);
    if (value >= 0 && i < parameter->categories.size()) return parameter->categories[i];
  }
  return fmt::format("{}", value);
}

std::vector<NamedText> parameters_of(const CertifiedResult& result) {
  const ChainSettings& chain = result.chain;
  std::vector<NamedText> list;
  if (chain.method != "none") list.push_back({"method", chain.method});
  list.push_back({"decimator", chain.decimator});
  const Parameters known =
      chain_parameters(chain.method == "none" ? std::string(kFitMethod) : chain.method,
                       chain.decimator, kAllFeatures);
  for (const auto& [name, value] : chain.parameters.by_name()) {
    const auto at = std::ranges::find(known, name, &Parameter::name);
    list.push_back({name, value_text(at == known.end() ? nullptr : &*at, value)});
  }
  if (result.evaluations > 0) {
    list.push_back({"seed", std::to_string(result.seed)});
    list.push_back({"evaluations", std::to_string(result.evaluations)});
  }
  return list;
}

}  // namespace

void check_report_outputs(const ReportOptions& options) {
  if (!options.report.empty()) check_output(options.report, kReportEndings);
  if (!options.picture.empty()) check_output(options.picture, kPictureEndings);
}

ReportData measured_report(const ReportOptions& wanted, const Scan& scan, MeshView mesh,
                           const std::vector<std::uint32_t>& excluded,
                           std::optional<double> epsilon) {
  ReportData report;
  report.program = "emax " EMAX_VERSION;
  if (scan.unit) report.unit = scan.unit->name;
  report.epsilon = epsilon;
  report.width = scan.width;
  report.measured = measure_for_report(
      scan.cloud, mesh, excluded, epsilon,
      {!wanted.report.empty(), !wanted.picture.empty(), report.unit.value_or("")},
      processor_threads());
  return report;
}

ReportData report_of_result(const ReportOptions& wanted, const CertifiedResult& result,
                            const std::filesystem::path& mesh_file,
                            const std::optional<WrittenResult>& written) {
  const ProvenMesh& proven = result.proven;
  ReportData report = measured_report(wanted, result.cloud.scan, result.mesh.view(),
                                      proven.points.excluded, result.epsilon);
  report.e_max = proven.points.e_max_upper;
  report.title = mesh_file.filename().string();
  report.within = written.has_value();
  report.verdict = verdict_of(result, written.has_value());
  if (proven.reference) report.back = proven.reference->mesh_to_reference;
  report.provenance.push_back(report_input("cloud", result.cloud.scan.path, result.cloud.sha256));
  if (written) report.provenance.push_back(report_input("mesh", mesh_file, written->mesh_sha256));
  if (proven.reference) {
    report.provenance.push_back(
        report_input("reference", proven.reference->file, proven.reference->sha256));
  }
  report.parameters = parameters_of(result);
  if (written) {
    const std::filesystem::path certificate = certificate_path(mesh_file);
    report.certificate = {certificate.filename().string(), written->certificate,
                          verify_command(result, certificate)};
  }
  return report;
}

ReportInput report_input(std::string name, const std::filesystem::path& file, std::string sha256) {
  return {std::move(name), name_of_input(file), std::move(sha256)};
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-=:,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

void write_report(const ReportOptions& wanted, ReportData report, Facts& facts) {
  report.facts = facts.kept();
  std::vector<OutputFile> files;
  if (!wanted.report.empty()) files.push_back({wanted.report, report_page(report)});
  if (!wanted.picture.empty()) files.push_back({wanted.picture, report.measured.picture});
  write_together(files);
  if (!wanted.report.empty()) facts.add("report", "{}: open it in a browser", wanted.report);
  if (!wanted.picture.empty()) facts.add("picture", "{}", wanted.picture);
}

}  // namespace emax
