#include "host/mpi/rank_measurement.h"

#include <fmt/format.h>

#include <utility>

#include "host/files/mesh_file.h"
#include "host/geometry/merge_vertices.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

TriangleMesh read_measured_mesh(const std::filesystem::path& path, bool used_vertices_alone,
                                std::uint32_t expected) {
  TriangleMesh mesh = read_mesh(path);
  if (used_vertices_alone) drop_unused_vertices(mesh.vertices, mesh.triangles);
  if (checksum(mesh) != expected) throw Error(path.string() + ": holds another mesh");
  return mesh;
}

}  // namespace

RankMeasurement::RankMeasurement(PiecesTask task, std::size_t threads)
    : task_(std::move(task)), threads_(threads), thread_([this] { measure(); }) {}

RankMeasurement::~RankMeasurement() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

void RankMeasurement::measure() {
  std::exception_ptr failure;
  try {
    measure_pieces();
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  failure_ = failure;
  ended_ = true;
  changed_.notify_all();
}

void RankMeasurement::measure_pieces() {
  const auto stopped = [this] { return is_stopped(); };
  const ScanPieces scan(task_.cloud, stopped);
  const MeterFiles& files = task_.files;
  const TriangleMesh mesh =
      read_measured_mesh(files.mesh, files.used_vertices_alone, task_.mesh_checksum);
  TriangleMesh reference;
  const bool has_reference = !files.reference.empty();
  if (has_reference) {
    reference = read_measured_mesh(files.reference, false, task_.reference_checksum);
  }
  PieceMeter meter(mesh, has_reference ? &reference : nullptr, scan.normalization(),
                   task_.brute_force, threads_);
  scan.for_each(threads_, task_.share, [&](const ScanPieces::Piece& piece) {
    push(encode(meter.measure(piece, task_.question, stopped), scan.normalization()));
  });
  MeterParts parts{meter.certificate().part(), {}};
  if (has_reference) parts.reference = meter.certificate_of_reference()->part();
  parts_ = encode(parts);
}

void RankMeasurement::push(Bytes found) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stopped_ || found_.size() < 2 * threads_; });
  if (stopped_) throw Interrupted{};
  found_.push_back(std::move(found));
  changed_.notify_all();
}

std::optional<Bytes> RankMeasurement::wait_for(std::chrono::milliseconds duration) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, duration, [&] { return ended_ || !found_.empty(); });
  if (failure_) std::rethrow_exception(failure_);
  if (found_.empty()) return std::nullopt;
  Bytes found = std::move(found_.front());
  found_.pop_front();
  changed_.notify_all();
  return found;
}

bool RankMeasurement::is_done() {
  const std::lock_guard lock(mutex_);
  return ended_ && !failure_ && found_.empty();
}

}  // namespace emax
