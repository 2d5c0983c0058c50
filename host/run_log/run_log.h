#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/geometry/triangle_mesh.h"
#include "host/run_log/record_file.h"

namespace emax {

// All settings that the results of a run depend on, by name, in the order in which they are
// compared. An empty value is not known yet; settle() sets it later.
using RunSettings = std::vector<std::pair<std::string, std::string>>;

struct LoggedEvaluation {
  std::uint64_t index = 0;  // of the candidate
  std::vector<double> genes;
  double seconds = 0;  // when it was known, of the time that the run's commands took

  std::string failure;  // the reason; empty for a candidate that was measured
  std::string message;  // one line

  double worked = 0;             // seconds that its worker took
  std::optional<double> walked;  // the value of the gene that the evaluation searched for itself
  std::uint64_t triangles = 0;
  std::vector<double> constraints;  // values of Problem::nonlinear, each at most 0 when it holds
  std::uint32_t squared_bits = 0;   // the kernel's e_max^2 over the points that are not excluded
  std::uint64_t reconstruction_triangles = 0, unmeshed_points = 0;
  // Where its decimation ended early, because it would hardly have become the best: what all of it
  // would have left, estimated.
  std::optional<std::uint64_t> expected_triangles;
  bool stopped = false;  // before its end: gives a mesh, but no result of the candidate
  std::optional<std::uint32_t> mesh_crc;  // CRC-32 of the mesh's file, if it was kept

  // Of the most violated constraint.
  double violation() const {
    return constraints.empty() ? 0 : *std::max_element(constraints.begin(), constraints.end());
  }

  bool operator==(const LoggedEvaluation&) const = default;
};

// A run's folder (docs/run_folder.md): its settings, a log of its evaluations that serves as cache
// and checkpoint, and the meshes that may become the result. Only one process at a time may use it.
class RunLog {
 public:
  // Creates the folder, or continues the run in it. Throws Error if another process uses it, if it
  // was made with other settings (the message names the first that differs), if it is not the
  // folder of a run, and if it cannot be written.
  RunLog(std::filesystem::path folder, const RunSettings& settings);
  // Removes the folder if it holds no evaluation and this object created it.
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  // Sets a value that is known only after the folder was opened. Throws Error as the constructor
  // does.
  void settle(const std::string& name, const std::string& value);

  // Adds `budget` to the budgets of the search in this folder if it is larger than the earlier
  // ones, and returns them all, ascending. A folder without evaluations has no earlier budgets.
  // Throws Error if it cannot be written.
  std::vector<std::size_t> give_budget(std::size_t budget);

  const std::filesystem::path& folder() const { return folder_; }
  std::size_t size() const { return evaluations_.size(); }  // evaluations
  RecordFile::Loss loss() const { return loss_; }           // when it was opened

  // The evaluation of candidate `index`; nullptr if there is none.
  const LoggedEvaluation* find(std::uint64_t index) const;

  const std::map<std::uint64_t, LoggedEvaluation>& evaluations() const { return evaluations_; }

  // As RecordFile::append. Throws Error, for example when the disk is full; earlier evaluations
  // stay.
  void append(LoggedEvaluation evaluation);
  // Also keeps the mesh until drop_mesh().
  void append(LoggedEvaluation evaluation, const TriangleMesh& mesh);

  // The mesh that was kept with the evaluation; nothing if it is missing or damaged.
  std::optional<TriangleMesh> mesh(const LoggedEvaluation& evaluation) const;
  void drop_mesh(std::uint64_t index);

  // Removes the folder with all of the run's files.
  void remove();

 private:
  std::filesystem::path mesh_path(std::uint64_t index) const;
  void create_folder();
  void open(const RunSettings& settings);
  void enter(std::span<const std::vector<std::uint8_t>> records);
  void compare(const RunSettings& settings) const;
  [[noreturn]] void differs(const std::string& name, const std::string& then,
                            const std::string& now) const;
  void find_meshes();

  std::filesystem::path folder_;
  bool created_ = false, removed_ = false;
  std::optional<RecordFile> log_;
  RecordFile::Loss loss_;
  std::map<std::uint64_t, LoggedEvaluation> evaluations_;
  std::set<std::uint64_t> meshes_;
};

// A record's content: one CBOR map.
std::vector<std::uint8_t> encode(const LoggedEvaluation& evaluation);
// Throws Error if the content is not an evaluation.
LoggedEvaluation decode_evaluation(std::span<const std::uint8_t> content);

}  // namespace emax
