#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host/engine/prepared_cloud.h"
#include "host/engine/prepared_mesh.h"
#include "sw_model/base/float_bits.h"

namespace emax {

struct EngineOptions {
  std::size_t threads = 1;
  Strategy strategy = Strategy::kAutomatic;
  const EngineTarget* target = nullptr;  // null: the best of engine_targets()
  // Called from time to time by one thread; true ends the question with Interrupted.
  std::function<bool()> interrupted = nullptr;
};

// d^2 of a point that has met no triangle: infinity.
inline constexpr std::uint32_t kNothingMet = kExponentMask;

struct Quantile {
  std::uint32_t squared_bits;         // nearest rank: the share of points has at most this d^2
  std::vector<std::uint32_t> beyond;  // points with a greater d^2, ascending
};

// Answers questions about the distance of a cloud's points to a mesh, with the bits of brute force
// in the kernel's arithmetic (docs/numerics.md), for any number of threads. A mesh is prepared with
// the cloud's normalization. An engine serves one caller at a time. The engine remembers the
// triangle that settled each point on the last mesh, 4.5 bytes a point; the triangle settles the
// point again where the next mesh has it, too. For that the engine holds the last mesh's records
// (MeshLeaves). O(n log m) in practice for n points and m triangles.
class ErrorEngine {
 public:
  // The cloud must outlive the engine. Throws std::invalid_argument for no threads.
  explicit ErrorEngine(const PreparedCloud& cloud, EngineOptions options = {});

  // The greatest d^2 and its point. The search begins with the packets that were worst on earlier
  // meshes.
  EmaxResult e_max(const PreparedMesh& mesh);
  // Nothing if every d^2 is within `limit_bits`, else a point beyond it with its d^2.
  std::optional<EmaxResult> violation(const PreparedMesh& mesh, std::uint32_t limit_bits);
  // d^2 of every point, in cloud order.
  std::vector<std::uint32_t> squared_distances(const PreparedMesh& mesh);
  // Lowers the d^2 of every point to that of this mesh, where that is less: after all parts of a
  // mesh they are those of the whole. Triangles that are farther are not looked at.
  void lower(const PreparedMesh& mesh, std::span<std::uint32_t> squared_bits);
  // Throws std::invalid_argument unless 0 < share <= 1.
  Quantile quantile(const PreparedMesh& mesh, double share);

  const EngineTarget& target() const { return target_; }
  void interrupt_with(std::function<bool()> interrupted) {
    options_.interrupted = std::move(interrupted);
  }
  // Drops what the engine remembers of earlier meshes. That changes only how long the next
  // questions take.
  void forget();

 private:
  SearchJob job(const PreparedMesh& mesh, RunningMaximum& worst, std::uint32_t enough,
                std::vector<std::uint32_t>& raised);
  // Maps the last mesh's triangles to those of this mesh.
  void begin(const PreparedMesh& mesh);
  // Calls work(thread, first, last) with flushing on.
  void in_supergroups(const std::function<void(std::size_t, std::size_t, std::size_t)>& work) const;
  void remember(std::uint32_t point, std::span<const std::vector<std::uint32_t>> raised);

  const PreparedCloud& cloud_;
  EngineOptions options_;
  const EngineTarget& target_;
  std::vector<std::uint32_t> remembered_;  // packets with an earlier answer, the latest last
  std::vector<SettledPacket> settled_;     // one for each packet
  std::shared_ptr<const MeshLeaves> mesh_;
  std::uint32_t mesh_number_;
  std::vector<std::uint32_t> carried_;  // leaves of the last mesh to those of the present one
};

}  // namespace emax
