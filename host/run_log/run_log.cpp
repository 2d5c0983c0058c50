#include "host/run_log/run_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <system_error>

#include "host/files/atomic_file.h"
#include "host/files/mesh_file.h"
#include "sw_model/base/crc32.h"
#include "sw_model/base/error.h"

namespace emax {
namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr const char* kLogName = "evaluations.log";
constexpr const char* kSettingsName = "settings.json";
constexpr std::string_view kMeshName = "mesh-";
constexpr std::string_view kMeshEnding = ".ply";

std::uint32_t crc_of(std::string_view bytes) {
  return crc32(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

std::optional<std::string> text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return std::nullopt;
  return text.str();
}

std::optional<std::uint64_t> index_of_mesh(const fs::path& path) {
  const std::string name = path.filename().string();
  std::uint64_t index = 0;
  const char* digits = name.data() + std::min(kMeshName.size(), name.size());
  const auto [end, failure] = std::from_chars(digits, name.data() + name.size(), index);
  const bool is_mesh = name.starts_with(kMeshName) && failure == std::errc{} && end == kMeshEnding;
  return is_mesh ? std::optional(index) : std::nullopt;
}

constexpr const char* kNotSaid = "(none)";
constexpr const char* kBudgets = "budgets";  // "20 40": may grow, so it is not compared

ordered_json settings_in(const fs::path& folder) {
  const fs::path path = folder / kSettingsName;
  const ordered_json settings =
      ordered_json::parse(text_of(path).value_or(""), nullptr, /*allow_exceptions=*/false);
  const bool sound = settings.is_object() && std::ranges::all_of(settings, [](const auto& value) {
                       return value.is_string();
                     });
  if (!sound) throw Error(path.string() + ": cannot be read; put it back or name another folder");
  return settings;
}

void write_settings(const fs::path& folder, const ordered_json& settings) {
  write_atomically(folder / kSettingsName, settings.dump(2) + "\n");
}

// Byte strings keep every bit.
ordered_json binary(const std::vector<double>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(double));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return ordered_json::binary(std::move(bytes));
}

std::vector<double> doubles(const ordered_json& json) {
  const auto& bytes = json.get_binary();
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

}  // namespace

std::vector<std::uint8_t> encode(const LoggedEvaluation& e) {
  ordered_json json = {{"index", e.index}, {"genes", binary(e.genes)}, {"seconds", e.seconds}};
  if (!e.failure.empty()) {
    json["failure"] = e.failure;
    json["message"] = e.message;
  } else {
    json["triangles"] = e.triangles;
    json["constraints"] = binary(e.constraints);
    json["e_max_squared_bits"] = e.squared_bits;
    json["reconstruction_triangles"] = e.reconstruction_triangles;
    json["unmeshed_points"] = e.unmeshed_points;
    json["worked"] = e.worked;
    if (e.walked) json["walked"] = *e.walked;
    if (e.expected_triangles) json["expected_triangles"] = *e.expected_triangles;
    if (e.stopped) json["stopped"] = true;
    if (e.mesh_crc) json["mesh_crc32"] = *e.mesh_crc;
  }
  return ordered_json::to_cbor(json);
}

LoggedEvaluation decode_evaluation(std::span<const std::uint8_t> content) {
  try {
    const ordered_json json = ordered_json::from_cbor(content.begin(), content.end());
    LoggedEvaluation e;
    json.at("index").get_to(e.index);
    e.genes = doubles(json.at("genes"));
    json.at("seconds").get_to(e.seconds);
    if (json.contains("failure")) {
      json.at("failure").get_to(e.failure);
      json.at("message").get_to(e.message);
      return e;
    }
    json.at("triangles").get_to(e.triangles);
    e.constraints = doubles(json.at("constraints"));
    json.at("e_max_squared_bits").get_to(e.squared_bits);
    json.at("reconstruction_triangles").get_to(e.reconstruction_triangles);
    json.at("unmeshed_points").get_to(e.unmeshed_points);
    json.at("worked").get_to(e.worked);
    if (json.contains("walked")) e.walked = json.at("walked").get<double>();
    if (json.contains("expected_triangles")) {
      e.expected_triangles = json.at("expected_triangles").get<std::uint64_t>();
    }
    e.stopped = json.value("stopped", false);
    if (json.contains("mesh_crc32")) e.mesh_crc = json.at("mesh_crc32").get<std::uint32_t>();
    return e;
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("not an evaluation: ") + error.what());
  }
}

RunLog::RunLog(fs::path folder, const RunSettings& settings) : folder_(std::move(folder)) {
  create_folder();
  try {
    open(settings);
  } catch (...) {
    // Removes the folder as the destructor would. Without the lock another process may have begun
    // there.
    if (created_ && log_) remove();
    throw;
  }
}

void RunLog::open(const RunSettings& settings) {
  log_.emplace(folder_ / kLogName);
  std::vector<std::vector<std::uint8_t>> records;
  loss_ = log_->read([&records](std::span<const std::uint8_t> content) {
    records.emplace_back(content.begin(), content.end());
  });
  if (!records.empty()) {
    compare(settings);  // before the records: another version may have written them in another form
    enter(records);
  } else {
    // The settings are written first, so that a log with records always has settings.
    ordered_json json;
    for (const auto& [name, value] : settings) json[name] = value;
    write_settings(folder_, json);
    log_->clear();
  }
  find_meshes();
}

RunLog::~RunLog() {
  if (!created_ || removed_ || !evaluations_.empty()) return;
  remove();
}

void RunLog::create_folder() {
  std::error_code failure;
  if (fs::is_directory(folder_, failure)) {
    if (fs::exists(folder_ / kLogName, failure) || fs::is_empty(folder_, failure)) return;
    throw Error(folder_.string() + ": holds other files than a run's; name another folder");
  }
  created_ = fs::create_directory(folder_, failure);
  if (!created_ && !fs::is_directory(folder_)) {
    throw Error(
        fmt::format("{}: cannot be created ({}); name a folder in a place that exists and "
                    "can be written",
                    folder_.string(), failure ? failure.message() : "not a folder"));
  }
}

void RunLog::enter(std::span<const std::vector<std::uint8_t>> records) {
  for (const std::vector<std::uint8_t>& content : records) {
    try {
      LoggedEvaluation evaluation = decode_evaluation(content);
      const std::uint64_t index = evaluation.index;
      evaluations_.insert_or_assign(index, std::move(evaluation));  // the last record counts
    } catch (const Error& error) {
      throw Error(fmt::format("{}: holds a record that is {}; name another folder",
                              log_->path().string(), error.what()));
    }
  }
}

void RunLog::compare(const RunSettings& settings) const {
  ordered_json there = settings_in(folder_);
  for (const auto& [name, value] : settings) {
    const std::string then = there.value(name, kNotSaid);
    if (then != value && !value.empty()) differs(name, then, value);
    there.erase(name);
  }
  there.erase(kBudgets);
  for (const auto& [name, value] : there.items()) {
    differs(name, value.get<std::string>(), kNotSaid);
  }
}

void RunLog::differs(const std::string& name, const std::string& then,
                     const std::string& now) const {
  throw Error(
      fmt::format("{}: the run there has {} {}, this one has {}; make them agree, name "
                  "another folder with --resume, or delete this one",
                  folder_.string(), name, then, now));
}

void RunLog::settle(const std::string& name, const std::string& value) {
  ordered_json there = settings_in(folder_);
  const std::string then = there.value(name, kNotSaid);
  if (then == value) return;
  if (!evaluations_.empty()) differs(name, then, value);
  there[name] = value;
  write_settings(folder_, there);
}

std::vector<std::size_t> RunLog::give_budget(std::size_t budget) {
  ordered_json there = settings_in(folder_);
  std::vector<std::size_t> budgets;
  if (!evaluations_.empty()) {
    std::istringstream text(there.value(kBudgets, std::string()));
    for (std::size_t earlier = 0; text >> earlier;) budgets.push_back(earlier);
  }
  if (budgets.empty() || budget > budgets.back()) {
    budgets.push_back(budget);
    there[kBudgets] = fmt::format("{}", fmt::join(budgets, " "));
    write_settings(folder_, there);
  }
  return budgets;
}

// Meshes without an evaluation are left from a run that was killed before the evaluation was
// written.
void RunLog::find_meshes() {
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::optional<std::uint64_t> index = index_of_mesh(entry.path());
    if (index && evaluations_.contains(*index)) {
      meshes_.insert(*index);
    } else if (index || entry.path().extension() == ".tmp") {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& path : leftovers) fs::remove(path);
}

const LoggedEvaluation* RunLog::find(std::uint64_t index) const {
  const auto found = evaluations_.find(index);
  return found == evaluations_.end() ? nullptr : &found->second;
}

void RunLog::append(LoggedEvaluation evaluation) {
  log_->append(encode(evaluation));
  const std::uint64_t index = evaluation.index;
  evaluations_.insert_or_assign(index, std::move(evaluation));
}

void RunLog::append(LoggedEvaluation evaluation, const TriangleMesh& mesh) {
  const std::string bytes = mesh_bytes(mesh, MeshFormat::kPly);
  evaluation.mesh_crc = crc_of(bytes);
  write_atomically(mesh_path(evaluation.index), bytes);
  meshes_.insert(evaluation.index);
  append(std::move(evaluation));
}

std::optional<TriangleMesh> RunLog::mesh(const LoggedEvaluation& evaluation) const {
  const fs::path path = mesh_path(evaluation.index);
  const std::optional<std::string> bytes = text_of(path);
  if (!bytes || !evaluation.mesh_crc || crc_of(*bytes) != *evaluation.mesh_crc) return std::nullopt;
  return read_mesh(path);
}

void RunLog::drop_mesh(std::uint64_t index) {
  if (meshes_.erase(index) == 0) return;
  std::error_code ignored;
  fs::remove(mesh_path(index), ignored);
}

// The order leaves either a new or a complete run if it is interrupted.
void RunLog::remove() {
  removed_ = true;
  evaluations_.clear();
  try {
    log_->clear();
  } catch (const Error&) {  // a new run has an empty log, too
  }
  std::error_code ignored;
  for (const std::uint64_t index : meshes_) fs::remove(mesh_path(index), ignored);
  meshes_.clear();
  fs::remove(folder_ / kSettingsName, ignored);
  fs::remove(folder_ / kLogName, ignored);
  fs::remove(folder_, ignored);
}

fs::path RunLog::mesh_path(std::uint64_t index) const {
  return folder_ / fmt::format("{}{}{}", kMeshName, index, kMeshEnding);
}

}  // namespace emax
