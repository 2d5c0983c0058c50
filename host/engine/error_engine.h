#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host/engine/prepared_cloud.h"
#include "host/engine/prepared_mesh.h"

namespace emax {

struct EngineOptions {
  std::size_t threads = 1;
  Strategy strategy = Strategy::kAutomatic;
  const EngineTarget* target = nullptr;  // the best of engine_targets() unless one is named
  // Asked now and then, by one thread; true ends a question with Interrupted.
  std::function<bool()> interrupted = nullptr;
};

struct Quantile {
  std::uint32_t squared_bits;         // the share of points within this d^2: nearest rank
  std::vector<std::uint32_t> beyond;  // points of a greater d^2, ascending
};

// Every question about the distance of a cloud's points to a mesh, answered with brute force's bits
// (docs/numerics.md): the kernel's d^2, whatever is culled, hinted at or remembered, with any
// number of threads. A mesh is prepared with the cloud's normalization. An engine serves one
// caller at a time. What settled a point on one mesh is kept, 4.5 bytes a point, and settles it
// on the next if that has the same triangle; for that the engine holds the last mesh's records
// (MeshLeaves). O(n log m) in practice for n points and m triangles.
class ErrorEngine {
 public:
  // The cloud must outlive the engine. Throws std::invalid_argument for no threads.
  explicit ErrorEngine(const PreparedCloud& cloud, EngineOptions options = {});

  // The greatest d^2 and its point. The search begins where the last meshes were worst.
  EmaxResult e_max(const PreparedMesh& mesh);
  // Whether every d^2 is within `limit_bits`: nothing, or a point that is not, with its d^2.
  std::optional<EmaxResult> violation(const PreparedMesh& mesh, std::uint32_t limit_bits);
  // d^2 of every point, in cloud order.
  std::vector<std::uint32_t> squared_distances(const PreparedMesh& mesh);
  // 0 < share <= 1, else std::invalid_argument.
  Quantile quantile(const PreparedMesh& mesh, double share);

  const EngineTarget& target() const { return target_; }
  void interrupt_with(std::function<bool()> interrupted) {
    options_.interrupted = std::move(interrupted);
  }
  // Drops what was remembered of earlier meshes; only times depend on it.
  void forget();

 private:
  SearchJob job(const PreparedMesh& mesh, RunningMaximum& worst, std::uint32_t enough,
                std::vector<std::uint32_t>& raised);
  // Finds the last mesh's triangles in this one.
  void begin(const PreparedMesh& mesh);
  // work(thread, first, last) with flushing on.
  void in_supergroups(const std::function<void(std::size_t, std::size_t, std::size_t)>& work) const;
  void remember(std::uint32_t point, std::span<const std::vector<std::uint32_t>> raised);

  const PreparedCloud& cloud_;
  EngineOptions options_;
  const EngineTarget& target_;
  std::vector<std::uint32_t> remembered_;  // packets that were worst, the latest last
  std::vector<SettledPacket> settled_;     // of packets
  std::shared_ptr<const MeshLeaves> mesh_;
  std::uint32_t mesh_number_;
  std::vector<std::uint32_t> carried_;  // leaves of the mesh before to those of the present one
};

}  // namespace emax
