#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/engine/packets.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The greatest distance so far, shared by threads: d^2 bits and the lowest index that has them, in
// one word that only grows. What it ends at does not depend on who raised it when.
class RunningMaximum {
 public:
  static std::uint64_t key(const EmaxResult& r) {
    return (std::uint64_t{r.squared_bits} + 1) << 32 | ~r.worst_point;
  }
  void raise(const EmaxResult& r) {
    std::uint64_t now = key_.load(std::memory_order_relaxed);
    while (now < key(r) && !key_.compare_exchange_weak(now, key(r), std::memory_order_relaxed)) {
    }
  }
  bool is_set() const { return load() != 0; }
  EmaxResult get() const {
    const std::uint64_t now = load();
    return {static_cast<std::uint32_t>((now >> 32) - 1), ~static_cast<std::uint32_t>(now)};
  }

 private:
  std::uint64_t load() const { return key_.load(std::memory_order_relaxed); }
  std::atomic<std::uint64_t> key_ = 0;
};

// How candidates for a packet are found. The answers are the same.
enum class Strategy {
  kAutomatic,  // by the radius beside the supergroup's size
  kPackets,    // collected for a supergroup and chosen for each of its packets
  kBestFirst,  // from the tree's root for each packet, the last one's triangle as hint
};

// What is known of a cloud's packets from the meshes before.
struct Settled {
  std::span<SettledPacket> packets;   // of the cloud
  std::uint32_t now = 0, before = 0;  // numbers of meshes
  // Leaf of mesh `before` to the same of `now`, or kNoLeaf, which stands behind the last, too.
  std::span<const std::uint32_t> carried;
};

struct SearchJob {
  PacketView cloud;
  TreeView mesh;
  Strategy strategy;
  RunningMaximum& worst;
  std::uint32_t enough;                // d^2 bits: a greater maximum ends the search
  std::vector<std::uint32_t>& raised;  // packets that raised the maximum are added
  Settled settled;
};

// The engine's inner loops for one kind of SIMD instructions. The same bits from every target.
struct EngineTarget {
  std::string_view name;

  // Records of the triangles and the blocks of their boxes; returns their reach. The vertices are
  // normalised and in range. O(n), about 100 operations on doubles each.
  float (*make_leaves)(std::span<const NormalizedVertex> vertices,
                       std::span<const Triangle> corners, std::span<const LeafKey> keys,
                       std::span<TriangleRecord<float>> records, std::span<BoxBlock> blocks);
  void (*make_level)(std::span<const BoxBlock> below, std::span<BoxBlock> level);

  // Raises the maximum by every point of these packets, exactly (best-first).
  void (*search_packets)(const SearchJob& job, std::span<const std::uint32_t> packets);
  // Raises it by all points of a range of supergroups, settling what it can against it.
  void (*search_supergroups)(const SearchJob& job, std::size_t first, std::size_t last);
  // d^2 bits of every point of a range of supergroups, by point index.
  void (*nearest)(const SearchJob& job, std::size_t first, std::size_t last,
                  std::span<std::uint32_t> squared_bits);
};

// Those this processor runs, best first; the last is plain.
std::span<const EngineTarget> engine_targets();

}  // namespace emax
